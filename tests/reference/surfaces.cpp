// One ray a sample finds the triangles that cover it; the material is looked up where the pixel centre's ray meets
// their planes, beyond their edges if need be, as a GPU extrapolates.
#include "surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shading.h"

namespace vitrail::tool::reference {

namespace {

constexpr double kSameDepth = 1e-6; // of the depth

// In sixteenths of a pixel.
constexpr std::array<std::array<int, 2>, 1> kOne = {{{8, 8}}};
constexpr std::array<std::array<int, 2>, 2> kTwo = {{{12, 12}, {4, 4}}};
constexpr std::array<std::array<int, 2>, 4> kFour = {{{6, 2}, {14, 6}, {2, 10}, {10, 14}}};
constexpr std::array<std::array<int, 2>, 8> kEight = {
    {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}}};

void findNearestOpaque(PixelSurfaces& found, std::uint32_t samples) {
  found.nearestOpaque.fill(-1);
  for (std::uint32_t s = 0; s < samples; ++s) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < found.opaque.size(); ++i) {
      const PixelSurface& surface = found.opaque[i];
      if ((surface.covered >> s & 1U) == 0 || !(surface.depths[s] <= nearest)) continue;
      nearest = surface.depths[s];
      found.nearestOpaque[s] = static_cast<int>(i);
    }
  }
}

// Tests a transparent surface against the opaque ones, sample by sample.
void testDepth(PixelSurface& surface, const PixelSurfaces& found, std::uint32_t samples) {
  for (std::uint32_t s = 0; s < samples; ++s) {
    if ((surface.covered >> s & 1U) == 0 || found.nearestOpaque[s] < 0) continue;
    const double opaque = found.opaque[static_cast<std::size_t>(found.nearestOpaque[s])].depths[s];
    if (surface.depths[s] > opaque) surface.hidden |= 1U << s;
    if (almostSameDepth(surface.depths[s], opaque)) surface.tied |= 1U << s;
  }
}

} // namespace

glm::dvec2 standardSamplePosition(std::uint32_t samples, std::uint32_t sample) {
  const std::array<int, 2>& at = samples == 1   ? kOne.at(sample)
                                 : samples == 2 ? kTwo.at(sample)
                                 : samples == 4 ? kFour.at(sample)
                                                : kEight.at(sample);
  return {at[0] / 16.0, at[1] / 16.0};
}

bool almostSameDepth(double a, double b) { return std::abs(a - b) <= kSameDepth * std::abs(a); }

double deviceDepth(const View& view, double depth) {
  const double near = view.nearPlane;
  const double far = view.farPlane;
  double z = 0.0;
  if (view.orthographic) {
    z = (far - depth) / (far - near);
  } else if (view.farPlane > 0.0F) {
    z = near * (far / depth - 1.0) / (far - near);
  } else {
    z = near / depth;
  }
  return std::clamp(z, 0.0, 1.0);
}

SurfaceFinder::SurfaceFinder(const Scene& scene, const ReferenceOptions& options)
    : scene_(scene),
      options_(options),
      rays_(scene, options.view),
      near_(options.view.nearPlane),
      far_(options.view.farPlane > 0.0F || options.view.orthographic ? double{options.view.farPlane}
                                                                     : std::numeric_limits<double>::infinity()) {
  for (const Mesh& mesh : scene.meshes) vertices_.push_back(mesh.vertices());
}

std::array<Vertex, 3> SurfaceFinder::corners(const RayHit& hit) const {
  const Mesh& mesh = meshOf(hit);
  const std::vector<Vertex>& vertices = vertices_[scene_.draws[hit.draw].mesh];
  const std::size_t first = std::size_t{hit.triangle} * 3;
  return {vertices[mesh.indices[first]], vertices[mesh.indices[first + 1]], vertices[mesh.indices[first + 2]]};
}

bool SurfaceFinder::isTransparent(const Material& material) const {
  return options_.opacity.has_value() || material.alphaMode == AlphaMode::Blend ||
         (material.transmission > 0.0F && !material.unlit);
}

// Every triangle that covers a sample between the clipping planes, at the pixel's centre.
std::vector<PixelSurface> SurfaceFinder::coveringTriangles(const glm::dvec2& centre, const glm::dvec2& snap,
                                                           std::vector<RayHit>& hits) const {
  const glm::dvec2 size(options_.width, options_.height);
  const std::array<PictureRay, 3> centreRays = {pictureRay(options_.view, centre - snap, size),
                                                pictureRay(options_.view, centre + snap, size),
                                                pictureRay(options_.view, centre + glm::dvec2(snap.y, -snap.x), size)};
  std::vector<PixelSurface> surfaces;
  for (std::uint32_t s = 0; s < options_.samples; ++s) {
    const glm::dvec2 at = centre - 0.5 + standardSamplePosition(options_.samples, s);
    rays_.allHits(pictureRay(options_.view, at, size), hits);
    for (const RayHit& hit : hits) {
      if (hit.depth < near_ || hit.depth > far_) continue;
      PixelSurface surface;
      surface.hit = hit;
      surface.covered = 1U << s;
      surface.depths[s] = hit.depth;
      surfaces.push_back(surface);
    }
  }
  if (options_.samples == 1) return surfaces; // the sample is the centre
  std::sort(surfaces.begin(), surfaces.end(),
            [](const PixelSurface& a, const PixelSurface& b) { return a.hit.number < b.hit.number; });
  std::vector<PixelSurface> joined;
  for (const PixelSurface& surface : surfaces) {
    if (joined.empty() || joined.back().hit.number != surface.hit.number) {
      joined.push_back(surface);
      joined.back().hit = rays_.onSamePlane(surface.hit, centreRays);
      continue;
    }
    joined.back().covered |= surface.covered;
    for (std::uint32_t s = 0; s < options_.samples; ++s) joined.back().depths[s] += surface.depths[s]; // one is 0
  }
  return joined;
}

// Fills in the base colour. False where the surface is culled or cut out.
bool SurfaceFinder::evaluate(PixelSurface& surface) const {
  const Material& material = materialOf(surface.hit);
  if (!surface.hit.front && !material.doubleSided && !isTransparent(material)) return false;
  glm::dvec4 color(0.0);
  glm::dvec2 uv(0.0);
  const std::array<Vertex, 3> corner = corners(surface.hit);
  const TextureSlot& slot = material.baseColorTexture;
  for (int i = 0; i < 3; ++i) {
    const Vertex& vertex = corner[static_cast<std::size_t>(i)];
    color += surface.hit.barycentric[i] * glm::dvec4(vertex.color);
    uv += surface.hit.barycentric[i] * glm::dvec2(slot.texCoord == 0 ? vertex.texCoord0 : vertex.texCoord1);
  }
  surface.base = glm::dvec4(material.baseColor) * color;
  if (slot.image >= 0) {
    surface.base *= sampleColorTexture(scene_.images[static_cast<std::size_t>(slot.image)], slot, uv,
                                       material.alphaMode != AlphaMode::Opaque);
  }
  double& alpha = surface.base.a;
  if (material.alphaMode == AlphaMode::Mask && alpha < double{material.alphaCutoff}) return false;
  if (material.alphaMode != AlphaMode::Blend) alpha = 1.0;
  if (options_.opacity) alpha *= double{*options_.opacity};
  return true;
}

PixelSurfaces SurfaceFinder::find(const glm::dvec2& centre, const glm::dvec2& snap, std::vector<RayHit>& hits) const {
  PixelSurfaces found;
  for (PixelSurface& surface : coveringTriangles(centre, snap, hits)) {
    if (!evaluate(surface)) continue;
    (isTransparent(materialOf(surface.hit)) ? found.transparent : found.opaque).push_back(surface);
  }
  findNearestOpaque(found, options_.samples);
  for (PixelSurface& surface : found.transparent) testDepth(surface, found, options_.samples);
  std::sort(found.transparent.begin(), found.transparent.end(), [&](const PixelSurface& a, const PixelSurface& b) {
    const double zA = deviceDepth(options_.view, a.hit.depth);
    const double zB = deviceDepth(options_.view, b.hit.depth);
    return zA != zB ? zA > zB : a.hit.number < b.hit.number;
  });
  return found;
}

} // namespace vitrail::tool::reference
