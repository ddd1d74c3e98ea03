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
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "../method.h"
#include "../methods.h"
#include "../shared/camera_distance.h"
#include "../shared/fixed_blending.h"
#include "../shared/host_clock.h"

namespace vitrail::tool {

namespace {

class Sorted final : public Method {
 public:
  Sorted(const MethodHost& host, const MethodOptions& options);

  ImageNeeds needs() const override { return {.perSample = true}; }
  void draw(Frame& frame) override;
  FrameStats stats() const override { return {}; }

 private:
  std::vector<SurfaceRun> sortedRuns(const Surfaces& surfaces) const;

  SurfacePipelines surfaces_;
  std::vector<SurfaceRun> runs_;    // the objects, in the order of submission
  std::vector<glm::dvec3> middles_; // of each, in the GPU's space
};

Sorted::Sorted(const MethodHost& host, const MethodOptions& options)
    : surfaces_(makeBlendedSurfaces(host, options, "sorted")) {
  const GpuScene& scene = host.surfaces.scene();
  for (std::uint32_t d = 0; d < scene.transparentDraws().size(); ++d) {
    const GpuDraw& draw = scene.transparentDraws()[d];
    const Bounds box = boundsOf(host.scene.meshes[draw.mesh]);
    const glm::dvec3 middle = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
    for (std::uint32_t i = draw.firstInstance; i < draw.firstInstance + draw.instanceCount; ++i) {
      middles_.emplace_back(glm::dmat4(scene.placeOf(host.scene, i)) * glm::dvec4(middle, 1.0));
      runs_.push_back({d, draw.firstIndex, draw.indexCount, i, 1});
    }
  }
}

// The farthest first; equal distances in the order of submission.
std::vector<SurfaceRun> Sorted::sortedRuns(const Surfaces& surfaces) const {
  std::vector<std::pair<double, SurfaceRun>> order;
  order.reserve(middles_.size());
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    order.emplace_back(distanceFromCamera(surfaces.view(), middles_[i]), runs_[i]);
  }
  std::ranges::stable_sort(order, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<SurfaceRun> runs;
  runs.reserve(order.size());
  for (const auto& [distance, run] : order) runs.push_back(run);
  return runs;
}

void Sorted::draw(Frame& frame) {
  const HostClock clock;
  const std::vector<SurfaceRun> runs = sortedRuns(frame.surfaces());
  frame.addHostPass("sort", clock.milliseconds());
  cmdBeginBlending(frame);
  frame.drawSurfaces(surfaces_, VK_NULL_HANDLE, runs);
  vkCmdEndRendering(frame.commands());
  frame.endPass("blend");
}

} // namespace

std::unique_ptr<Method> makeSorted(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<Sorted>(host, options);
}

} // namespace vitrail::tool
