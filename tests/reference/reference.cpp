// One pixel at a time: find the surfaces, shade them once, sort the transparent ones, blend each sample, average.
#include "reference.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "../../tool/scene/exposure.h"
#include "library/reference/resolve.h"
#include "media.h"
#include "rays.h"
#include "shading.h"
#include "surfaces.h"

namespace vitrail::tool::reference {

namespace {

using Samples = std::array<Blended, kMostSamples>;

constexpr double kNudge = 1.0 / 256.0;      // pixels; Vulkan asks for at least 4 bits, drivers have 8
constexpr double kEdgeChange = 0.5 / 255.0; // on the sRGB curve
constexpr double kOpaqueEnough = 1e-10;     // what is left to see behind this much is not looked at
constexpr double kLargestHalf = 65504.0;    // opaque colours are kept as 16-bit floats

// What a renderer that is right may be given for alpha: materials with alphas such as 0.7 lie exactly between two steps
// in single precision, and on one side of the middle in double precision. This is the single-precision step.
double snapAlpha(double alpha, const NodeCoding& coding) {
  const float largest = coding.format == layout::VITRAIL_FORMAT_STANDARD ? 255.0F
                        : coding.format == layout::VITRAIL_FORMAT_HDR    ? 65535.0F
                        : coding.samples == 1                            ? 63.0F
                                                                         : 31.0F;
  const bool root = coding.format == layout::VITRAIL_FORMAT_HDR;
  const auto clamped = static_cast<float>(std::clamp(alpha, 0.0, 1.0));
  const float scaled = (root ? std::sqrt(clamped) : clamped) * largest;
  const double step = static_cast<double>(std::floor(scaled + 0.5F)) / double{largest};
  return root ? step * step : step;
}

// Straight alpha on the sRGB curve, in [0, 1]: what the 8-bit picture rounds. The section "Output".
glm::dvec4 displayColor(const glm::dvec4& premultiplied) {
  const double alpha = std::clamp(premultiplied.a, 0.0, 1.0);
  glm::dvec3 straight(0.0);
  glm::dvec3 light(0.0);
  for (int c = 0; c < 3; ++c) {
    if (alpha > 0.0) straight[c] = encodeSrgb(std::clamp(premultiplied[c] / alpha, 0.0, 1.0));
    const double beyond = std::max(premultiplied[c] - 1.002 * alpha, 0.0);
    if (alpha < 1.0) light[c] = encodeSrgb(std::min(beyond / (1.0 - alpha), 1.0));
  }
  const double brightest = std::max({light.r, light.g, light.b});
  if (brightest <= 0.0) return {straight, alpha};
  const double raised = std::ceil((alpha + (1.0 - alpha) * brightest) * 255.0) / 255.0;
  return {(alpha * straight + (1.0 - alpha) * light) / raised, raised};
}

double largestChange(const glm::dvec4& a, const glm::dvec4& b) {
  const glm::dvec4 change = glm::abs(a - b);
  return std::max({change.r, change.g, change.b, change.a});
}

// What is seen in a pixel.
struct Sight {
  glm::dvec4 exact{0.0};
  glm::dvec4 rounded{0.0};
  glm::dvec4 tiesSwapped{0.0}; // exact, with surfaces of almost equal depth in the opposite order
  std::uint32_t layers = 0;
};

class Eye {
 public:
  Eye(const Scene& scene, const ReferenceOptions& options);

  // Looks at the pixel around a point of the picture, with all rays moved by `nudge`, and corners of triangles half as
  // far where they are followed to the centre: drivers snap them to their grid. Without a nudge with everything in
  // Sight; else `exact` and `layers` only.
  Sight look(const glm::dvec2& centre, const glm::dvec2& nudge, std::vector<RayHit>& hits) const;

 private:
  using Fragments = std::vector<Fragment>;

  glm::dvec3 shadeSurface(const PictureRay& ray, const PixelSurface& surface) const;
  Fragments fragmentsOf(const PictureRay& ray, const PixelSurface& surface) const;
  std::uint32_t storedCount(const PictureRay& ray, const PixelSurface& surface) const;
  std::vector<PixelSurface> swapTies(const std::vector<PixelSurface>& surfaces) const;
  Samples blend(const PictureRay& ray, const std::vector<PixelSurface>& surfaces, PixelList* stored) const;
  std::vector<Crossing> crossings(const PictureRay& ray, const std::vector<PixelSurface>& surfaces,
                                  std::uint32_t sample) const;
  Blended blendAbsorbing(const PictureRay& ray, const PixelSurfaces& found, const std::vector<PixelSurface>& surfaces,
                         std::uint32_t sample, bool rounded) const;
  Samples blendAll(const PictureRay& ray, const PixelSurfaces& found, const std::vector<PixelSurface>& surfaces,
                   PixelList* stored) const;
  std::array<Color, kMostSamples> opaqueColors(const PictureRay& ray, const PixelSurfaces& surfaces) const;
  Color behindEverything(const PictureRay& ray) const;
  glm::dvec4 mean(const Samples& samples, const std::array<Color, kMostSamples>& behind) const;

  const ReferenceOptions& options_;
  const Scene& scene_;
  double exposure_;
  SurfaceFinder finder_;
  NodeCoding coding_;
  double brightest_; // of a stored colour
  glm::dmat3 cameraAxes_;
  glm::dvec3 toLight_;
  std::vector<glm::dmat3> normalToWorld_; // by draw
  std::vector<double> growth_;            // by draw: the cube root of its transform's determinant
  SolidDraws solids_;
  bool absorbs_ = false; // whether any draw is solid
};

void checkTextures(const Scene& scene) {
  for (const Material& material : scene.materials) {
    for (const TextureSlot* slot :
         {&material.metallicRoughnessTexture, &material.normalTexture, &material.occlusionTexture,
          &material.emissiveTexture, &material.transmissionTexture, &material.specularTexture,
          &material.specularColorTexture, &material.clearcoatTexture, &material.clearcoatRoughnessTexture,
          &material.sheenColorTexture, &material.sheenRoughnessTexture, &material.anisotropyTexture,
          &material.iridescenceTexture, &material.iridescenceThicknessTexture, &material.thicknessTexture}) {
      if (slot->image >= 0) throw std::invalid_argument("the reference knows base colour textures only");
    }
  }
}

Eye::Eye(const Scene& scene, const ReferenceOptions& options)
    : options_(options),
      scene_(scene),
      exposure_(lightExposure(scene)),
      finder_(scene, options),
      coding_{options.nodeFormat, options.samples, true},
      brightest_(options.nodeFormat == layout::VITRAIL_FORMAT_HDR ? kLargestHalf : 1.0),
      cameraAxes_(glm::dmat4(options.view.cameraToWorld)),
      toLight_(cameraAxes_ * glm::normalize(glm::dvec3(-0.4, 0.7, 0.6))),
      solids_(scene, double{options.opacity.value_or(1.0F)}) {
  checkTextures(scene);
  for (const Draw& draw : scene.draws) {
    growth_.push_back(std::cbrt(std::abs(glm::determinant(glm::dmat3(glm::dmat4(draw.transform))))));
    absorbs_ = absorbs_ || solids_.isSolid(static_cast<std::uint32_t>(growth_.size() - 1));
    normalToWorld_.push_back(glm::transpose(glm::inverse(glm::dmat3(glm::dmat4(draw.transform)))));
  }
}

// What the extensions of a material are.
void setExtensions(Surface& lit, const Material& material) {
  lit.ior = double{material.ior};
  lit.specular = double{material.specular};
  lit.specularColor = glm::dvec3(material.specularColor);
  lit.specularGlossiness = material.specularGlossiness;
  lit.clearcoat = double{material.clearcoat};
  lit.clearcoatRoughness = double{material.clearcoatRoughness};
  lit.sheenColor = glm::dvec3(material.sheenColor);
  lit.sheenRoughness = double{material.sheenRoughness};
  lit.anisotropy = double{material.anisotropy};
  lit.anisotropyRotation = double{material.anisotropyRotation};
  lit.iridescence = double{material.iridescence};
  lit.iridescenceIor = double{material.iridescenceIor};
  lit.filmThickness = double{material.iridescenceThickness.y};
  lit.diffuseTransmission = double{material.diffuseTransmission};
  lit.diffuseTransmissionColor = glm::dvec3(material.diffuseTransmissionColor);
}

// The colour of the section "Colour" of docs/shading.md.
glm::dvec3 Eye::shadeSurface(const PictureRay& ray, const PixelSurface& surface) const {
  const RayHit& hit = surface.hit;
  const Material& material = finder_.materialOf(hit);
  const glm::dvec3 base(surface.base);
  if (material.unlit) return base;
  glm::dvec3 normal(0.0);
  glm::dvec3 tangent(0.0);
  glm::dvec3 point(0.0);
  const glm::dmat4 transform(scene_.draws[hit.draw].transform);
  const std::array<Vertex, 3> corner = finder_.corners(hit);
  const glm::dvec3 first(corner[0].position);
  const glm::dvec3 plane = glm::cross(glm::dvec3(corner[1].position) - first, glm::dvec3(corner[2].position) - first);
  for (int i = 0; i < 3; ++i) {
    const Vertex& vertex = corner[static_cast<std::size_t>(i)];
    const glm::dvec3 vertexNormal = finder_.meshOf(hit).normals.empty() ? plane : glm::dvec3(vertex.normal);
    normal += hit.barycentric[i] * (normalToWorld_[hit.draw] * vertexNormal);
    tangent += hit.barycentric[i] * (glm::dmat3(transform) * glm::dvec3(vertex.tangent));
    point += hit.barycentric[i] * glm::dvec3(transform * glm::dvec4(glm::dvec3(vertex.position), 1.0));
  }
  Surface lit;
  setExtensions(lit, material);
  lit.tangent = glm::dvec4(tangent, corner[0].tangent.w);
  lit.ownLight = scene_.lights.empty();
  for (const Light& light : scene_.lights) lit.lights.push_back(shineOf(light, exposure_, point));
  lit.normal = glm::normalize(normal) * (hit.front ? 1.0 : -1.0);
  const glm::dvec3 fromEye(ray.slope, -1.0); // camera space; an orthographic ray has no slope
  lit.toEye = cameraAxes_ * glm::normalize(-fromEye);
  lit.toLight = toLight_;
  lit.base = base;
  lit.emissive = glm::dvec3(material.emissive);
  lit.metallic = double{material.metallic};
  lit.roughness = double{material.roughness};
  lit.transmission = std::clamp(double{material.transmission}, 0.0, 1.0);
  return shade(lit);
}

// What a transparent surface hands to vitrailCollect(), the nearer fragment first; its coverage is what is seen of it.
Eye::Fragments Eye::fragmentsOf(const PictureRay& ray, const PixelSurface& surface) const {
  const Material& material = finder_.materialOf(surface.hit);
  const glm::dvec3 color = shadeSurface(ray, surface);
  const double k = surface.base.a;
  const auto depth = static_cast<float>(deviceDepth(options_.view, surface.hit.depth));
  const std::uint32_t seen = surface.covered & ~surface.hidden;
  const auto fragment = [&](const glm::dvec3& rgb, double alpha, std::uint32_t mode) {
    const glm::dvec3 c = glm::clamp(rgb, 0.0, brightest_);
    return Fragment{{c.r, c.g, c.b, std::clamp(alpha, 0.0, 1.0)}, depth, mode, seen};
  };
  const double t = material.unlit ? 0.0 : std::clamp(double{material.transmission}, 0.0, 1.0);
  if (t > 0.0) {
    const double q = t * (1.0 - std::clamp(double{material.metallic}, 0.0, 1.0));
    const double passing = 1.0 - k + k * q;
    glm::dvec3 tint(surface.base);
    const Fragment reflection = fragment(k * color, k * (1.0 - q), layout::VITRAIL_PREMULTIPLIED);
    if (solids_.isSolid(surface.hit.draw)) {
      const double share = passing > 0.0 ? k * q / passing : 0.0;
      return {reflection, fragment(glm::mix(glm::dvec3(1.0), tint, share), 1.0, layout::VITRAIL_MULTIPLY)};
    }
    if (surface.hit.front) {
      tint *= glm::exp(-absorptionOf(material) * double{material.thickness} * growth_[surface.hit.draw]);
    }
    return {reflection, fragment(tint, passing > 0.0 ? k * q / passing : 0.0, layout::VITRAIL_MULTIPLY)};
  }
  const bool adds = material.alphaMode == AlphaMode::Blend && material.blend == BlendMode::Additive;
  return {fragment(color, k, adds ? layout::VITRAIL_ADDITIVE : layout::VITRAIL_OVER)};
}

// How many nodes a surface takes. Shading is left out where alpha alone decides.
std::uint32_t Eye::storedCount(const PictureRay& ray, const PixelSurface& surface) const {
  if ((surface.covered & ~surface.hidden) == 0) return 0;
  if (finder_.materialOf(surface.hit).transmission <= 0.0F) return snapAlpha(surface.base.a, coding_) > 0.0 ? 1 : 0;
  std::uint32_t count = 0;
  for (Fragment fragment : fragmentsOf(ray, surface)) {
    fragment.color[3] = snapAlpha(fragment.color[3], coding_);
    if (packNode(coding_, fragment)) ++count;
  }
  return count;
}

// What a list might be in a renderer that knows depths less well: each run of surfaces whose neighbours are at almost
// the same depth is reversed, and the opaque surfaces hide those at almost their depth exactly where they did not
// before.
std::vector<PixelSurface> Eye::swapTies(const std::vector<PixelSurface>& surfaces) const {
  const auto tied = [&](const PixelSurface& a, const PixelSurface& b) {
    if (almostSameDepth(a.hit.depth, b.hit.depth)) return true;
    if (options_.nodeFormat != layout::VITRAIL_FORMAT_COMPACT) return false;
    const double near = deviceDepth(options_.view, a.hit.depth);
    const double step = options_.samples == 1 ? 0x1p-11 : 0x1p-9; // the largest between two codes, of the nearness
    return std::abs(near - deviceDepth(options_.view, b.hit.depth)) <= step * near;
  };
  std::vector<PixelSurface> swapped;
  for (std::size_t first = 0; first < surfaces.size();) {
    std::size_t end = first + 1;
    while (end < surfaces.size() && tied(surfaces[end - 1], surfaces[end])) ++end;
    for (std::size_t i = end; i-- > first;) {
      swapped.push_back(surfaces[i]);
      swapped.back().hidden ^= surfaces[i].tied;
    }
    first = end;
  }
  return swapped;
}

// Blends each sample, without rounding. `stored`: receives the nodes of all that is not behind enough.
Samples Eye::blend(const PictureRay& ray, const std::vector<PixelSurface>& surfaces, PixelList* stored) const {
  Samples samples;
  const auto isOpaque = [&](std::uint32_t s) {
    const Color& t = samples[s].transmittance;
    return std::max({t[0], t[1], t[2], t[3]}) < kOpaqueEnough;
  };
  for (const PixelSurface& surface : surfaces) {
    const std::uint32_t seen = surface.covered & ~surface.hidden;
    std::uint32_t wanted = 0;
    for (std::uint32_t s = 0; s < options_.samples; ++s) {
      if ((seen >> s & 1U) != 0 && !isOpaque(s)) wanted |= 1U << s;
    }
    if (wanted == 0) continue;
    for (Fragment fragment : fragmentsOf(ray, surface)) {
      for (std::uint32_t s = 0; s < options_.samples; ++s) {
        if ((wanted >> s & 1U) != 0) samples[s] = compose(samples[s], blendOf(fragment));
      }
      if (stored == nullptr) continue;
      fragment.color[3] = snapAlpha(fragment.color[3], coding_);
      if (const auto node = packNode(coding_, fragment)) stored->nodes.push_back(*node);
    }
  }
  return samples;
}

// Where a sample's ray goes through solids, at the pixel's centre.
std::vector<Crossing> Eye::crossings(const PictureRay& ray, const std::vector<PixelSurface>& surfaces,
                                     std::uint32_t sample) const {
  const double stretch = glm::length(glm::dvec3(ray.slope, 1.0));
  std::vector<Crossing> result;
  for (const PixelSurface& surface : surfaces) {
    if ((surface.covered >> sample & 1U) == 0 || !solids_.isSolid(surface.hit.draw)) continue;
    result.push_back(
        {surface.hit.draw, solids_.isEntry(surface.hit.draw, surface.hit.front), surface.hit.depth * stretch});
  }
  return result;
}

// One sample of a scene with solids: every fragment is weakened by what is between the near plane and it. What comes
// from behind all of them is weakened in the transmittance. `rounded`: fragments as they are stored.
Blended Eye::blendAbsorbing(const PictureRay& ray, const PixelSurfaces& found,
                            const std::vector<PixelSurface>& surfaces, std::uint32_t sample, bool rounded) const {
  const double stretch = glm::length(glm::dvec3(ray.slope, 1.0));
  const double start = double{options_.view.nearPlane} * stretch;
  const std::vector<Crossing> all = crossings(ray, surfaces, sample);
  Blended result; // of the surfaces alone
  Blended seen;   // with what is between them
  const auto weaken = [](Color& color, const glm::dvec3& left) {
    for (int c = 0; c < 3; ++c) color[static_cast<std::size_t>(c)] *= left[c];
  };
  for (const PixelSurface& surface : surfaces) {
    if ((surface.covered & ~surface.hidden & 1U << sample) == 0) continue;
    const glm::dvec3 left = solids_.left(all, start, surface.hit.depth * stretch);
    for (Fragment fragment : fragmentsOf(ray, surface)) {
      if (rounded) {
        fragment.color[3] = snapAlpha(fragment.color[3], coding_);
        const auto node = packNode(coding_, fragment);
        if (!node) continue;
        fragment = unpackNode(coding_, *node);
      }
      Color light = result.transmittance;
      weaken(light, left);
      const Blended blended = blendOf(fragment);
      for (std::size_t c = 0; c < 4; ++c) seen.color[c] += light[c] * blended.color[c];
      result = compose(result, blended);
    }
  }
  const int nearest = found.nearestOpaque[sample];
  double end = start;
  for (const Crossing& crossing : all) end = std::max(end, crossing.at);
  if (double{options_.view.farPlane} > 0.0) end = double{options_.view.farPlane} * stretch;
  if (nearest >= 0) end = found.opaque[static_cast<std::size_t>(nearest)].depths[sample] * stretch;
  seen.transmittance = result.transmittance;
  weaken(seen.transmittance, solids_.left(all, start, end));
  return seen;
}

// `stored`: as in blend(), of a scene without solids.
Samples Eye::blendAll(const PictureRay& ray, const PixelSurfaces& found, const std::vector<PixelSurface>& surfaces,
                      PixelList* stored) const {
  if (!absorbs_) return blend(ray, surfaces, stored);
  Samples samples;
  for (std::uint32_t s = 0; s < options_.samples; ++s) samples[s] = blendAbsorbing(ray, found, surfaces, s, false);
  return samples;
}

Color Eye::behindEverything(const PictureRay& ray) const {
  glm::dvec3 color(0.0);
  switch (options_.background.kind) {
    case Background::Kind::Transparent:
      return {};
    case Background::Kind::Sky:
      color = skyColor(glm::normalize(cameraAxes_ * glm::dvec3(ray.slope, -1.0)));
      break;
    case Background::Kind::Color:
      for (int i = 0; i < 3; ++i) color[i] = decodeSrgb(options_.background.srgb[i]);
      break;
  }
  return {color.r, color.g, color.b, 1.0};
}

std::array<Color, kMostSamples> Eye::opaqueColors(const PictureRay& ray, const PixelSurfaces& surfaces) const {
  const Color background = behindEverything(ray);
  std::vector<Color> shaded;
  for (const PixelSurface& surface : surfaces.opaque) {
    const glm::dvec3 c = glm::min(shadeSurface(ray, surface), kLargestHalf);
    shaded.push_back({c.r, c.g, c.b, 1.0});
  }
  std::array<Color, kMostSamples> colors{};
  for (std::uint32_t s = 0; s < options_.samples; ++s) {
    const int nearest = surfaces.nearestOpaque[s];
    colors[s] = nearest < 0 ? background : shaded[static_cast<std::size_t>(nearest)];
  }
  return colors;
}

glm::dvec4 Eye::mean(const Samples& samples, const std::array<Color, kMostSamples>& behind) const {
  glm::dvec4 sum(0.0);
  for (std::uint32_t s = 0; s < options_.samples; ++s) {
    const Color color = over(samples[s], behind[s]);
    sum += glm::dvec4(color[0], color[1], color[2], color[3]);
  }
  return sum / static_cast<double>(options_.samples);
}

bool sameOrder(const std::vector<PixelSurface>& a, const std::vector<PixelSurface>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const PixelSurface& x, const PixelSurface& y) {
    return x.hit.number == y.hit.number && x.hidden == y.hidden;
  });
}

Sight Eye::look(const glm::dvec2& centre, const glm::dvec2& nudge, std::vector<RayHit>& hits) const {
  const bool still = nudge == glm::dvec2(0.0);
  const glm::dvec2 pixel = centre + nudge;
  const PictureRay ray = pictureRay(options_.view, pixel, {options_.width, options_.height});
  const PixelSurfaces surfaces = finder_.find(pixel, 0.5 * nudge, hits);
  const std::array<Color, kMostSamples> behind = opaqueColors(ray, surfaces);

  Sight sight;
  for (const PixelSurface& surface : surfaces.transparent) sight.layers += storedCount(ray, surface);
  PixelList stored{coding_, {}, {}, 0};
  PixelList* const wanted = still && !absorbs_ ? &stored : nullptr;
  sight.exact = mean(blendAll(ray, surfaces, surfaces.transparent, wanted), behind);
  if (!still) return sight;
  if (absorbs_) {
    Samples samples;
    for (std::uint32_t s = 0; s < options_.samples; ++s) {
      samples[s] = blendAbsorbing(ray, surfaces, surfaces.transparent, s, true);
    }
    sight.rounded = mean(samples, behind);
  } else {
    const Color rounded = resolvePixel(stored, behind);
    sight.rounded = {rounded[0], rounded[1], rounded[2], rounded[3]};
  }
  const std::vector<PixelSurface> swapped = swapTies(surfaces.transparent);
  sight.tiesSwapped =
      sameOrder(surfaces.transparent, swapped) ? sight.exact : mean(blendAll(ray, surfaces, swapped, nullptr), behind);
  return sight;
}

void putPixel(ReferencePicture& out, std::size_t index, const glm::dvec4& linear) {
  out.linear[index] = linear;
  const glm::dvec4 display = displayColor(linear);
  for (int c = 0; c < 4; ++c) out.picture.rgba[index * 4 + static_cast<std::size_t>(c)] = quantize8(display[c]);
}

void renderPixel(const Eye& eye, std::uint32_t x, std::uint32_t y, std::vector<RayHit>& hits, Reference& out) {
  const std::size_t index = std::size_t{y} * out.exact.picture.width + x;
  const glm::dvec2 centre(x + 0.5, y + 0.5);
  const Sight sight = eye.look(centre, glm::dvec2(0.0), hits);
  putPixel(out.exact, index, sight.exact);
  putPixel(out.rounded, index, sight.rounded);
  out.layers[index] = sight.layers;
  LayerRange range{sight.layers, sight.layers};
  const glm::dvec4 display = displayColor(sight.exact);
  double change = largestChange(display, displayColor(sight.tiesSwapped));
  for (const glm::dvec2 corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(-1, 1), glm::dvec2(1, 1)}) {
    const Sight near = eye.look(centre, kNudge * corner, hits);
    change = std::max(change, largestChange(display, displayColor(near.exact)));
    range.least = std::min(range.least, near.layers);
    range.most = std::max(range.most, near.layers);
  }
  out.layerRanges[index] = range;
  out.edge[index] = change > kEdgeChange ? 1 : 0;
}

ReferencePicture blankPicture(const ReferenceOptions& options) {
  const std::size_t pixels = std::size_t{options.width} * options.height;
  ReferencePicture out;
  out.linear.resize(pixels);
  out.picture.width = options.width;
  out.picture.height = options.height;
  out.picture.hasAlpha = options.background.kind == Background::Kind::Transparent;
  out.picture.rgba.resize(pixels * 4);
  return out;
}

} // namespace

Reference renderReference(const Scene& scene, const ReferenceOptions& options) {
  const Eye eye(scene, options);
  const std::size_t pixels = std::size_t{options.width} * options.height;
  Reference out{blankPicture(options), blankPicture(options), {}, {}, {}};
  out.layers.resize(pixels);
  out.layerRanges.resize(pixels);
  out.edge.resize(pixels);

  std::atomic<std::uint32_t> nextRow{0};
  const auto work = [&] {
    std::vector<RayHit> hits;
    for (std::uint32_t y = nextRow++; y < options.height; y = nextRow++) {
      for (std::uint32_t x = 0; x < options.width; ++x) renderPixel(eye, x, y, hits, out);
    }
  };
  std::vector<std::thread> workers(std::max(1U, std::thread::hardware_concurrency()));
  for (std::thread& worker : workers) worker = std::thread(work);
  for (std::thread& worker : workers) worker.join();
  return out;
}

} // namespace vitrail::tool::reference
