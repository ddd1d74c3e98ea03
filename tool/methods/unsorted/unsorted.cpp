// Plain alpha blending in the order of submission, by fixed function: what a renderer without order-independent
// transparency does, wrong wherever a nearer surface comes first. Every cost is compared with it.
//
// Cost: one draw of the surfaces, whose every fragment reads and writes the colour once. No memory.
#include <memory>

#include "../method.h"
#include "../methods.h"
#include "../shared/fixed_blending.h"

namespace vitrail::tool {

namespace {

class Unsorted final : public Method {
 public:
  Unsorted(const MethodHost& host, const MethodOptions& options);

  ImageNeeds needs() const override { return {.perSample = true}; }
  void draw(Frame& frame) override;
  FrameStats stats() const override { return {}; }

 private:
  SurfacePipelines surfaces_;
};

Unsorted::Unsorted(const MethodHost& host, const MethodOptions& options)
    : surfaces_(makeBlendedSurfaces(host, options, "unsorted")) {}

void Unsorted::draw(Frame& frame) {
  cmdBeginBlending(frame);
  frame.drawSurfaces(surfaces_);
  vkCmdEndRendering(frame.commands());
  frame.endPass("blend");
}

} // namespace

std::unique_ptr<Method> makeUnsorted(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<Unsorted>(host, options);
}

} // namespace vitrail::tool
