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
#include <memory>

#include "../method.h"
#include "../methods.h"
#include "../shared/fixed_blending.h"
#include "../shared/host_clock.h"
#include "object_order.h"

namespace vitrail::tool {

namespace {

class Sorted final : public Method {
 public:
  Sorted(const MethodHost& host, const MethodOptions& options)
      : surfaces_(makeBlendedSurfaces(host, options, "sorted")), order_(host.surfaces.scene(), host.scene) {}

  ImageNeeds needs() const override { return {.perSample = true}; }
  void draw(Frame& frame) override;
  FrameStats stats() const override { return {}; }

 private:
  SurfacePipelines surfaces_;
  ObjectOrder order_;
};

void Sorted::draw(Frame& frame) {
  const HostClock clock;
  const std::vector<SurfaceRun> runs = order_.farthestFirst(frame.surfaces().view());
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
