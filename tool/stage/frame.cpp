#include "frame.h"

namespace vitrail::tool {

Frame::Frame(Submitter& submitter, Timers& timers, PictureImages& images, const Surfaces& surfaces, bool timesSteps)
    : submitter_(submitter),
      timers_(timers),
      images_(images),
      surfaces_(surfaces),
      timesSteps_(timesSteps),
      commands_(submitter.begin()) {
  timers_.startFrame();
  timers_.cmdStart(commands_);
}

void Frame::drawSurfaces(const SurfacePipelines& pipelines, VkDescriptorSet set) {
  drawSurfaces(pipelines, set, surfaces_.transparentRuns());
}

void Frame::drawSurfaces(const SurfacePipelines& pipelines, VkDescriptorSet set, std::span<const SurfaceRun> runs,
                         VkBuffer indices) {
  surfaces_.cmdDraw(commands_, surfaces_.scene().transparentDraws(), runs, pipelines, set, indices);
}

void Frame::endPass(const std::string& name) { timers_.cmdEndPass(commands_, name); }

void Frame::endStep(const std::string& name) {
  if (timesSteps_) endPass(name);
}

void Frame::addHostPass(const std::string& name, double milliseconds) { timers_.addHostPass(name, milliseconds); }

void Frame::submitAndWait() {
  finish();
  commands_ = submitter_.begin();
  timers_.cmdStart(commands_);
}

void Frame::finish() {
  submit();
  submitter_.wait();
  timers_.addSubmission();
}

void Frame::submit() {
  submitter_.submit("frame");
  commands_ = VK_NULL_HANDLE;
}

} // namespace vitrail::tool
