// The surfaces in one pixel: which samples each covers, and what the material is there. Samples are at Vulkan's
// standard positions; everything but coverage and the depth test is taken at the pixel's centre, once a surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "../../tool/scene/scene.h"
#include "rays.h"
#include "reference.h"

namespace vitrail::tool::reference {

constexpr std::uint32_t kMostSamples = 8;

// Where a sample lies in its pixel, from the pixel's top left corner: the table "Standard sample locations" of the
// Vulkan specification. `samples` is 1, 2, 4 or 8.
glm::dvec2 standardSamplePosition(std::uint32_t samples, std::uint32_t sample);

// One triangle in a pixel.
struct PixelSurface {
  RayHit hit;           // at the centre, on the triangle's plane
  glm::dvec4 base{1.0}; // colour factor times texture times vertex colour; alpha with the X-ray factor
  // Samples, a bit each: that the triangle covers; those of them where an opaque surface is before it; and those where
  // one is at almost the same depth, so that a renderer that is right may see it either way.
  std::uint32_t covered = 0;
  std::uint32_t hidden = 0;
  std::uint32_t tied = 0;
  std::array<double, kMostSamples> depths{}; // view depths at the covered samples
};

struct PixelSurfaces {
  std::vector<PixelSurface> opaque;
  std::array<int, kMostSamples> nearestOpaque{}; // by sample: an index into `opaque`, or -1
  std::vector<PixelSurface> transparent;         // the nearest at the centre first, hidden ones too
};

// A depth along the camera's axis as gl_FragCoord.z, clamped to [0, 1]: reversed, 1 at the near plane.
double deviceDepth(const View& view, double depth);

class SurfaceFinder {
 public:
  SurfaceFinder(const Scene& scene, const ReferenceOptions& options);

  // The surfaces in the pixel around `centre`, a point of the picture. With several samples the corners of triangles
  // are moved by `snap` pixels, each in a direction of its own, before their planes are followed to the centre: where
  // that is far outside of a thin triangle, a little changes much. `hits` is scratch memory.
  PixelSurfaces find(const glm::dvec2& centre, const glm::dvec2& snap, std::vector<RayHit>& hits) const;

  [[nodiscard]] std::array<Vertex, 3> corners(const RayHit& hit) const;
  [[nodiscard]] bool isTransparent(const Material& material) const;
  [[nodiscard]] const Mesh& meshOf(const RayHit& hit) const { return scene_.meshes[scene_.draws[hit.draw].mesh]; }
  [[nodiscard]] const Material& materialOf(const RayHit& hit) const {
    return scene_.materials[scene_.draws[hit.draw].material];
  }

 private:
  [[nodiscard]] std::vector<PixelSurface> coveringTriangles(const glm::dvec2& centre, const glm::dvec2& snap,
                                                            std::vector<RayHit>& hits) const;
  bool evaluate(PixelSurface& surface) const;

  const Scene& scene_;
  const ReferenceOptions& options_;
  std::vector<std::vector<Vertex>> vertices_; // by mesh
  RayScene rays_;
  double near_;
  double far_;
};

// Whether two depths are so close that a renderer that is right may order them either way.
bool almostSameDepth(double a, double b);

} // namespace vitrail::tool::reference
