// The method sorted (sorted.cpp) with OpenGL.
#include <memory>

#include "../methods.h"
#include "../shared/gl_fixed_blending.h"
#include "../shared/host_clock.h"
#include "object_order.h"

namespace vitrail::tool {

namespace {

class GlSorted final : public GlMethod {
 public:
  explicit GlSorted(const GlMethodHost& host) : surfaces_(host, "sorted"), order_(host.surfaces.scene(), host.scene) {}

  GlImageNeeds needs() const override { return {.perSample = true}; }
  void draw(GlFrame& frame) override {
    const HostClock clock;
    const std::vector<SurfaceRun> runs = order_.farthestFirst(frame.surfaces().view());
    frame.addHostPass("sort", clock.milliseconds());
    surfaces_.draw(frame, runs);
    frame.endPass("blend");
  }
  FrameStats stats() const override { return {}; }

 private:
  GlBlendedSurfaces surfaces_;
  ObjectOrder order_;
};

} // namespace

std::unique_ptr<GlMethod> makeGlSorted(const GlMethodHost& host, const MethodOptions& /*options*/) {
  return std::make_unique<GlSorted>(host);
}

} // namespace vitrail::tool
