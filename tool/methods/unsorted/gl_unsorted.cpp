// The method unsorted (unsorted.cpp) with OpenGL.
#include <memory>

#include "../methods.h"
#include "../shared/gl_fixed_blending.h"

namespace vitrail::tool {

namespace {

class GlUnsorted final : public GlMethod {
 public:
  explicit GlUnsorted(const GlMethodHost& host) : surfaces_(host, "unsorted") {}

  GlImageNeeds needs() const override { return {.perSample = true}; }
  void draw(GlFrame& frame) override {
    surfaces_.draw(frame, frame.surfaces().transparentRuns());
    frame.endPass("blend");
  }
  FrameStats stats() const override { return {}; }

 private:
  GlBlendedSurfaces surfaces_;
};

} // namespace

std::unique_ptr<GlMethod> makeGlUnsorted(const GlMethodHost& host, const MethodOptions& /*options*/) {
  return std::make_unique<GlUnsorted>(host);
}

} // namespace vitrail::tool
