// Random frames with everything that a host can ask for, and the materials of their draws, which the rasteriser
// evaluates in floats and the reference in doubles.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "host.h"

namespace vitrail::tests::raster {

// Where a fragment is, and what becomes of it.
template <class Real>
struct Surface {
  std::uint32_t x = 0; // pixel of the picture
  std::uint32_t y = 0;
  std::uint32_t triangle = 0;
  bool front = false;
  Real depth{};
  Real second{};
  Real third{};
  std::array<Real, 4> color{};
  std::array<Real, 3> filter{};
  bool discarded = false;
};

// Colours that change smoothly over a triangle, from `color` to `other`; what is discarded depends on whole numbers, so
// that floats and doubles agree on it.
struct Material {
  std::array<float, 4> color{};
  std::array<float, 4> other{};
  std::array<float, 3> filter{1.0F, 1.0F, 1.0F};
  std::uint32_t discardEvery = 0; // 0: nothing

  template <class Real>
  void shade(Surface<Real>& s) const {
    // Where a pixel's centre lies outside of the triangle, weights go beyond 0 and 1.
    const auto within = [](Real v) { return std::clamp(v, Real(0), Real(1)); };
    const Real third = within(s.third);
    const Real t = (within(s.second) + Real(0.5) * third + s.depth) / Real(2.5);
    for (std::size_t c = 0; c < 4; ++c) s.color[c] = Real(color[c]) + t * (Real(other[c]) - Real(color[c]));
    if (!s.front) s.color[0] *= Real(0.5);
    for (std::size_t c = 0; c < 3; ++c) s.filter[c] = Real(filter[c]) * (Real(1) - Real(0.25) * third);
    s.discarded = discardEvery > 0 && (s.x + 3 * s.y + s.triangle) % discardEvery == 0;
  }
};

// The shade function of a material.
void shadeMaterial(void* material, VitrailCpuFragments* fragments);

struct SceneDraw {
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<float> planes;
  std::array<float, 12> model{};
  std::array<float, 16> transform{};
  Material material;
  VitrailCpuDraw desc{}; // points to these
};

struct SceneOptions {
  std::uint32_t width = 90;
  std::uint32_t height = 70;
  std::uint32_t samples = 1;
  std::uint32_t draws = 8;
  std::uint32_t primitives = 12; // of a draw, at most
  VitrailCpuClipSpace clipSpace = VITRAIL_CPU_CLIP_VULKAN;
  VitrailDepthOrder depthOrder = VITRAIL_DEPTH_NEAREST_IS_ZERO;
  bool isFlat = false;   // no shade functions
  bool isShaded = false; // shade functions only; else both
  bool hasFilters = false;
  bool hasDiscards = false;
  bool hasOpaque = false;
  bool hasDepth = false; // of the host's
  bool hasOtherTopologies = false;
  bool hasPlanes = false;
  bool hasCulling = false;
  bool hasOddVertices = false; // indices, strides, three components, matrices
  bool isClipped = false;      // triangles reach through the near and the far plane
  bool hasSampleColors = false;
};

struct Scene {
  VitrailCpuFrame frame{}; // without its arrays
  std::vector<std::unique_ptr<SceneDraw>> draws;
  std::vector<float> background;   // 4 floats a pixel
  std::vector<float> sampleColors; // 4 times samples a pixel, or empty
  std::vector<float> depth;        // samples a pixel, or empty

  std::vector<VitrailCpuDraw> descs() const;
};

Scene randomScene(Random& random, const SceneOptions& options);

// What the rasteriser makes of a scene.
struct Drawn {
  std::vector<float> pixels;
  std::vector<float> depth;
  VitrailStats stats{};

  bool operator==(const Drawn& other) const; // the same bits
};

// `counts`: asks for statistics, which are 0 else.
Drawn draw(Raster& raster, const Scene& scene, std::uint64_t memoryBudget = 0, bool counts = true);
Drawn draw(Raster& raster, const Scene& scene, const std::vector<VitrailCpuDraw>& draws, std::uint64_t memoryBudget = 0,
           bool counts = true);

} // namespace vitrail::tests::raster
