// One pixel at a time: gather the ray's hits, find the opaque one, sort the transparent ones before it, blend.
#include "reference.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include "rays.h"
#include "shading.h"

namespace vitrail::tool::reference {

namespace {

constexpr double kNudge = 1.0 / 256.0;      // pixels; Vulkan asks for at least 4 bits, drivers have 8
constexpr double kSameDepth = 1e-6;         // of the depth
constexpr double kEdgeChange = 0.5 / 255.0; // on the sRGB curve
constexpr double kOpaqueEnough = 1e-7;      // what is left to see behind this much is not looked at

// A transparent surface on a ray.
struct Fragment {
  const RayHit* hit = nullptr;
  glm::dvec4 base{1.0}; // colour factor times texture times vertex colour; alpha with the X-ray factor
  double storedAlpha = 1.0;
};

// What a ray meets.
struct Surfaces {
  std::optional<Fragment> opaque;    // the nearest one
  std::vector<Fragment> visible;     // transparent and before it, front to back
  std::vector<Fragment> tiesSwapped; // what `visible` could be where depths are almost equal
};

// Alpha as 8 bits hold it. The product is a single-precision one: materials with alphas such as 0.7 lie exactly between
// two steps there, and on one side of the middle in double precision.
double storeAlpha(double alpha) {
  const float scaled = static_cast<float>(std::clamp(alpha, 0.0, 1.0)) * 255.0F;
  return static_cast<double>(std::floor(scaled + 0.5F)) / 255.0;
}

glm::dvec3 storeColor(const glm::dvec3& color) {
  const auto channel = [](double c) { return decodeSrgb(quantize8(encodeSrgb(std::clamp(c, 0.0, 1.0))) / 255.0); };
  return {channel(color.r), channel(color.g), channel(color.b)};
}

// Front to back over-blending.
class Blend {
 public:
  void add(const glm::dvec3& color, double alpha) {
    color_ += left_ * alpha * color;
    left_ *= 1.0 - alpha;
  }
  double left() const { return left_; }
  glm::dvec4 over(const glm::dvec4& behind) const { return glm::dvec4(color_, 1.0 - left_) + left_ * behind; }

 private:
  glm::dvec3 color_{0.0};
  double left_ = 1.0;
};

// Straight alpha on the sRGB curve, in [0, 1]: what the 8-bit picture rounds.
glm::dvec4 displayColor(const glm::dvec4& premultiplied) {
  const double alpha = premultiplied.a;
  const auto channel = [&](double c) { return alpha > 0.0 ? encodeSrgb(std::clamp(c / alpha, 0.0, 1.0)) : 0.0; };
  return {channel(premultiplied.r), channel(premultiplied.g), channel(premultiplied.b), std::clamp(alpha, 0.0, 1.0)};
}

double largestChange(const glm::dvec4& a, const glm::dvec4& b) {
  const glm::dvec4 change = glm::abs(a - b);
  return std::max({change.r, change.g, change.b, change.a});
}

// What a ray sees.
struct Sight {
  glm::dvec4 exact{0.0};
  glm::dvec4 rounded{0.0};
  glm::dvec4 tiesSwapped{0.0}; // exact, with surfaces of almost equal depth in the opposite order
  std::uint32_t layers = 0;
};

class Eye {
 public:
  Eye(const Scene& scene, const ReferenceOptions& options);

  // Follows the ray through a point of the picture. `centre`: with everything in Sight; else `exact` and `layers` only.
  Sight look(const glm::dvec2& pixel, bool centre, std::vector<RayHit>& hits) const;

 private:
  std::array<Vertex, 3> corners(const RayHit& hit) const;
  Surfaces gather(const std::vector<RayHit>& hits) const;
  std::optional<Fragment> fragmentOf(const RayHit& hit) const;
  glm::dvec3 shadeHit(const PictureRay& ray, const RayHit& hit, const glm::dvec3& base) const;
  glm::dvec4 behindEverything(const PictureRay& ray) const;
  bool isTransparent(const Material& material) const {
    return options_.opacity.has_value() || material.alphaMode == AlphaMode::Blend;
  }
  const Material& materialOf(const RayHit& hit) const { return scene_.materials[scene_.draws[hit.draw].material]; }

  const Scene& scene_;
  const ReferenceOptions& options_;
  RayScene rays_;
  glm::dmat3 cameraAxes_;
  glm::dvec3 eye_;
  glm::dvec3 toLight_;
  double near_;
  double far_;
  std::vector<glm::dmat4> toWorld_;       // by draw
  std::vector<glm::dmat3> normalToWorld_; // by draw
};

void checkTextures(const Scene& scene) {
  for (const Material& material : scene.materials) {
    if (material.metallicRoughnessTexture.image >= 0 || material.normalTexture.image >= 0 ||
        material.occlusionTexture.image >= 0 || material.emissiveTexture.image >= 0) {
      throw std::invalid_argument("the reference knows base colour textures only");
    }
  }
}

Eye::Eye(const Scene& scene, const ReferenceOptions& options)
    : scene_(scene),
      options_(options),
      rays_(scene, options.view),
      cameraAxes_(glm::dmat4(options.view.cameraToWorld)),
      eye_(glm::dmat4(options.view.cameraToWorld)[3]),
      toLight_(cameraAxes_ * glm::normalize(glm::dvec3(-0.4, 0.7, 0.6))),
      near_(options.view.nearPlane),
      far_(options.view.farPlane > 0.0F || options.view.orthographic ? double{options.view.farPlane}
                                                                     : std::numeric_limits<double>::infinity()) {
  checkTextures(scene);
  for (const Draw& draw : scene.draws) {
    toWorld_.emplace_back(draw.transform);
    normalToWorld_.push_back(glm::transpose(glm::inverse(glm::dmat3(toWorld_.back()))));
  }
}

std::array<Vertex, 3> Eye::corners(const RayHit& hit) const {
  const Mesh& mesh = scene_.meshes[scene_.draws[hit.draw].mesh];
  const std::size_t first = std::size_t{hit.triangle} * 3;
  return {mesh.vertices[mesh.indices[first]], mesh.vertices[mesh.indices[first + 1]],
          mesh.vertices[mesh.indices[first + 2]]};
}

// The surface that a hit is, or nothing where it is clipped, culled or cut out.
std::optional<Fragment> Eye::fragmentOf(const RayHit& hit) const {
  if (hit.depth < near_ || hit.depth > far_) return std::nullopt;
  const Material& material = materialOf(hit);
  const bool transparent = isTransparent(material);
  if (!hit.front && !material.doubleSided && !transparent) return std::nullopt;

  glm::dvec4 color(0.0);
  glm::dvec2 uv(0.0);
  const std::array<Vertex, 3> corner = corners(hit);
  const TextureSlot& slot = material.baseColorTexture;
  for (int i = 0; i < 3; ++i) {
    const Vertex& vertex = corner[static_cast<std::size_t>(i)];
    color += hit.barycentric[i] * glm::dvec4(vertex.color);
    uv += hit.barycentric[i] * glm::dvec2(slot.texCoord == 0 ? vertex.texCoord0 : vertex.texCoord1);
  }
  Fragment fragment{&hit, glm::dvec4(material.baseColor) * color, 1.0};
  if (slot.image >= 0) {
    fragment.base *= sampleColorTexture(scene_.images[static_cast<std::size_t>(slot.image)], slot, uv);
  }
  double& alpha = fragment.base.a;
  if (material.alphaMode == AlphaMode::Mask && alpha < double{material.alphaCutoff}) return std::nullopt;
  if (material.alphaMode != AlphaMode::Blend) alpha = 1.0;
  if (options_.opacity) alpha *= double{*options_.opacity};
  fragment.storedAlpha = storeAlpha(alpha);
  return fragment;
}

glm::dvec3 Eye::shadeHit(const PictureRay& ray, const RayHit& hit, const glm::dvec3& base) const {
  const Material& material = materialOf(hit);
  if (material.unlit) return base;
  glm::dvec3 normal(0.0);
  const std::array<Vertex, 3> corner = corners(hit);
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 vertexNormal(corner[static_cast<std::size_t>(i)].normal);
    normal += hit.barycentric[i] * (normalToWorld_[hit.draw] * vertexNormal);
  }
  Surface surface;
  surface.normal = glm::normalize(normal) * (hit.front ? 1.0 : -1.0);
  const glm::dvec3 fromEye(ray.slope, -1.0); // camera space; an orthographic ray has no slope
  surface.toEye = cameraAxes_ * glm::normalize(-fromEye);
  surface.toLight = toLight_;
  surface.base = base;
  surface.emissive = glm::dvec3(material.emissive);
  surface.metallic = double{material.metallic};
  surface.roughness = double{material.roughness};
  return shade(surface);
}

glm::dvec4 Eye::behindEverything(const PictureRay& ray) const {
  switch (options_.background.kind) {
    case Background::Kind::Transparent:
      return glm::dvec4(0.0);
    case Background::Kind::Sky:
      return {skyColor(glm::normalize(cameraAxes_ * glm::dvec3(ray.slope, -1.0))), 1.0};
    case Background::Kind::Color:
      break;
  }
  const glm::dvec3 srgb(options_.background.srgb);
  return {decodeSrgb(srgb.r), decodeSrgb(srgb.g), decodeSrgb(srgb.b), 1.0};
}

bool sameOrder(const std::vector<Fragment>& a, const std::vector<Fragment>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Fragment& x, const Fragment& y) { return x.hit == y.hit; });
}

bool sameDepth(const Fragment& a, const Fragment& b) {
  return std::abs(a.hit->depth - b.hit->depth) <= kSameDepth * std::abs(a.hit->depth);
}

// What a list might be in a renderer that knows depths less well: each run of fragments whose neighbours are at almost
// the same depth is reversed, and the opaque surface hides those at almost its depth exactly where it did not before.
// `fragments` is sorted and still holds what is behind the opaque surface.
std::vector<Fragment> swapTies(const std::vector<Fragment>& fragments, const std::optional<Fragment>& opaque) {
  std::vector<Fragment> swapped;
  for (std::size_t first = 0; first < fragments.size();) {
    std::size_t end = first + 1;
    while (end < fragments.size() && sameDepth(fragments[end], fragments[end - 1])) ++end;
    for (std::size_t i = end; i-- > first;) {
      const bool hidden = opaque && fragments[i].hit->depth >= opaque->hit->depth;
      if (hidden == (opaque && sameDepth(fragments[i], *opaque))) swapped.push_back(fragments[i]);
    }
    first = end;
  }
  return swapped;
}

Surfaces Eye::gather(const std::vector<RayHit>& hits) const {
  Surfaces found;
  std::vector<Fragment>& fragments = found.visible;
  for (const RayHit& hit : hits) {
    const std::optional<Fragment> fragment = fragmentOf(hit);
    if (!fragment) continue;
    if (isTransparent(materialOf(hit))) {
      fragments.push_back(*fragment);
    } else if (!found.opaque || hit.depth < found.opaque->hit->depth) {
      found.opaque = fragment;
    }
  }
  std::sort(fragments.begin(), fragments.end(),
            [](const Fragment& a, const Fragment& b) { return a.hit->depth < b.hit->depth; });
  found.tiesSwapped = swapTies(fragments, found.opaque);
  std::erase_if(fragments, [&](const Fragment& f) { return found.opaque && f.hit->depth >= found.opaque->hit->depth; });
  return found;
}

Sight Eye::look(const glm::dvec2& pixel, bool centre, std::vector<RayHit>& hits) const {
  const PictureRay ray = pictureRay(options_.view, pixel, {options_.width, options_.height});
  rays_.allHits(ray, hits);
  const Surfaces surfaces = gather(hits);
  const std::optional<Fragment>& opaque = surfaces.opaque;
  const glm::dvec4 behind =
      opaque ? glm::dvec4(shadeHit(ray, *opaque->hit, glm::dvec3(opaque->base)), 1.0) : behindEverything(ray);
  const auto colorOf = [&](const Fragment& fragment) {
    return glm::clamp(shadeHit(ray, *fragment.hit, glm::dvec3(fragment.base)), 0.0, 1.0);
  };

  Sight sight;
  Blend exact;
  Blend rounded;
  for (const Fragment& fragment : surfaces.visible) {
    if (fragment.storedAlpha > 0.0) ++sight.layers;
    if ((centre ? std::max(exact.left(), rounded.left()) : exact.left()) < kOpaqueEnough) continue;
    const glm::dvec3 color = colorOf(fragment);
    exact.add(color, std::clamp(fragment.base.a, 0.0, 1.0));
    if (centre) rounded.add(storeColor(color), fragment.storedAlpha);
  }
  sight.exact = exact.over(behind);
  if (!centre) return sight;
  sight.rounded = rounded.over(behind);
  sight.tiesSwapped = sight.exact;
  if (!sameOrder(surfaces.visible, surfaces.tiesSwapped)) {
    Blend swapped;
    for (const Fragment& fragment : surfaces.tiesSwapped) {
      if (swapped.left() < kOpaqueEnough) break;
      swapped.add(colorOf(fragment), std::clamp(fragment.base.a, 0.0, 1.0));
    }
    sight.tiesSwapped = swapped.over(behind);
  }
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
  const Sight sight = eye.look(centre, true, hits);
  putPixel(out.exact, index, sight.exact);
  putPixel(out.rounded, index, sight.rounded);
  out.layers[index] = sight.layers;
  LayerRange range{sight.layers, sight.layers};
  const glm::dvec4 display = displayColor(sight.exact);
  double change = largestChange(display, displayColor(sight.tiesSwapped));
  for (const glm::dvec2 corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(-1, 1), glm::dvec2(1, 1)}) {
    const Sight near = eye.look(centre + kNudge * corner, false, hits);
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
