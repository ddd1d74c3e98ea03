// Whole objects back to front by the distance of their bounds' middle from the camera, blended by fixed function with
// the depth test on and depth writes off: the painter's algorithm of Newell, Newell and Sancha, "A solution to the
// hidden surface problem" (ACM 1972), without its splitting, as renderers do it today (Akenine-Moller et al.,
// "Real-Time Rendering", 4th edition, 5.5). An object is one draw of the scene.
//
// Cost: a sort of the objects on the host, once a frame, n log n in their number, and one draw of the surfaces as in
// `unsorted`. Draws that bind the same things come apart. No memory on the device.
//
// What it gets wrong: objects that pass through each other or overlap in a cycle, which have no order; an object whose
// middle is nearer than another's while the part that is seen is farther, such as a small thing before a large floor;
// and the surfaces of one object among themselves, which stay in the order of its triangles. A camera that moves makes
// objects change places from one frame to the next: they pop.
#pragma once

#include <vector>

#include "../method.h"

namespace vitrail::tool {

class Sorted final : public Method {
 public:
  // Throws GpuError.
  Sorted(const MethodHost& host, const MethodOptions& options);

  std::string_view name() const override { return "sorted"; }
  MethodNeeds needs() const override { return {.perSample = true}; }
  void draw(Frame& frame) override;
  MethodStats stats() const override { return {.counted = false}; }

 private:
  std::vector<SurfaceRun> sortedRuns(const Surfaces& surfaces) const;

  SurfacePipelines surfaces_;
  std::vector<glm::dvec3> middles_; // of the transparent draws, in the GPU's space
};

} // namespace vitrail::tool
