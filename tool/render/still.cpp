#include "still.h"

#include "../gpu/submit.h"
#include "../gpu/timers.h"
#include "../methods/method.h"
#include "../methods/methods.h"
#include "../stage/frame.h"
#include "../stage/stage.h"
#include "attempts.h"
#include "encode_pass.h"

namespace vitrail::tool {

struct StillRenderer::Impl {
  MethodOptions options;
  std::vector<std::string> warnings; // of what the method, or the device, draws otherwise
  Submitter submitter;
  Stage stage;                    // the method's target holds views of its images
  std::unique_ptr<Method> method; // draws on it
  EncodePass encode;
  std::uint64_t encodedImages = 0; // of the stage, that `encode` reads: which those are
  Timers timers;

  Impl(Gpu& gpu, const Scene& scene, const StageInfo& info, const MethodOptions& chosen);
  void setSize(VkExtent2D size);
  MethodTarget targetOf(const RenderOptions& picture);
  std::vector<std::string> warningsOf(const RenderOptions& picture, const FrameStats& stats) const;
  void prepare(const RenderOptions& picture);
  bool draw(const RenderOptions& picture, bool encoded);
  FrameReport drawUntilComplete(const RenderOptions& picture, bool encoded);
  bool isBackgroundAlone(const RenderOptions& picture, const RenderResult& drawn);
};

StillRenderer::Impl::Impl(Gpu& gpu, const Scene& scene, const StageInfo& info, const MethodOptions& chosen)
    : options(chosen),
      warnings(methodWarnings(scene, chosen)),
      submitter(gpu),
      stage(gpu, scene, info),
      method(makeMethod({gpu, stage.surfaces(), scene}, chosen)),
      encode(gpu),
      timers(gpu, Frame::kMostPasses) {
  stage.setNeeds(method->needs());
  warnOfPoints(scene, stage.surfaces().pointSize(), gpu.properties().deviceName, warnings);
}

void StillRenderer::Impl::setSize(VkExtent2D size) {
  if (stage.hasSize(size)) return;
  method->releaseTarget();
  stage.setSize(size);
}

void StillRenderer::Impl::prepare(const RenderOptions& picture) {
  checkPictureOptions(options, picture.memoryBudget.has_value(), picture.peel > 0);
  const VkExtent2D size{picture.width, picture.height};
  setSize(size);
  stage.images().setPart(size);
  if (encodedImages != stage.imagesMade()) {
    encode.setSource(stage.images().color().get());
    encodedImages = stage.imagesMade();
  }
  encode.setEncoding(picture.encoding);
  stage.setView(picture.view);
  method->setTarget(targetOf(picture));
}

MethodTarget StillRenderer::Impl::targetOf(const RenderOptions& picture) {
  PictureImages& images = stage.images();
  MethodTarget target;
  target.extent = images.size();
  target.color = images.color().get().view();
  target.opaque = images.multisampled().view();
  target.depth = images.sampledDepth();
  target.stencil = images.sampledStencil();
  target.memoryBudget = picture.memoryBudget;
  target.peel = picture.peel;
  target.onTile = picture.onTile;
  target.surfaces = !stage.surfaces().scene().transparentDraws().empty();
  return target;
}

std::vector<std::string> StillRenderer::Impl::warningsOf(const RenderOptions& picture, const FrameStats& stats) const {
  std::vector<std::string> all = warnings;
  if (picture.peel == 0) return all;
  if (stats.fragmentsRequested == 0) all.push_back(nothingPeeledWarning());
  if (stage.surfaces().scene().solids().any()) {
    all.emplace_back("volumes are attenuated by the file's thickness, not by the true path: leave --peel out");
  }
  return all;
}

// Draws a picture. False: the method has made room, and the picture must be drawn again.
bool StillRenderer::Impl::draw(const RenderOptions& picture, bool encoded) {
  Frame frame(submitter, timers, stage.images(), stage.surfaces(), picture.timesSteps);
  stage.drawOpaque(frame, picture.background);
  method->draw(frame);
  stage.finishPicture(frame);
  if (encoded) {
    stage.images().cmdToEncode(frame.commands());
    encode.cmdEncode(frame.commands());
    frame.endPass("encode");
  }
  frame.finish();
  return method->finish();
}

FrameReport StillRenderer::Impl::drawUntilComplete(const RenderOptions& picture, bool encoded) {
  prepare(picture);
  const std::string device = stage.gpu().properties().deviceName;
  const FrameStats stats = tool::drawUntilComplete(
      device, [&] { return draw(picture, encoded); }, [&] { return method->stats(); });
  FrameReport report = reportOf(stats, picture, options, timers.milliseconds());
  report.device = device;
  report.api = kVulkanApi;
  report.warnings = warningsOf(picture, stats);
  report.peakBytes = stage.gpu().peakMemory();
  return report;
}

// Whether the background, drawn in the same way without the scene, is the same picture.
bool StillRenderer::Impl::isBackgroundAlone(const RenderOptions& picture, const RenderResult& drawn) {
  if (!mayBeBackground(picture, drawn)) return false;
  Frame frame(submitter, timers, stage.images(), stage.surfaces());
  stage.drawBackground(frame, picture.background);
  stage.images().cmdToEncode(frame.commands());
  encode.cmdEncode(frame.commands());
  frame.endPass("encode");
  frame.finish();
  return picture.encoding == Encoding::Srgb8 ? encode.pixels() == drawn.picture.rgba
                                             : encode.deepPixels() == drawn.deep.rgba;
}

StillRenderer::StillRenderer(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order,
                             const MethodOptions& method)
    : impl_(std::make_unique<Impl>(gpu, scene, StageInfo{opacity, order, method.samples}, method)) {}

StillRenderer::StillRenderer(Gpu& gpu, Scene&& scene, std::optional<float> opacity, const MethodOptions& method) {
  StageInfo info{opacity, DrawOrder::Forward, method.samples};
  if (!traitsOf(method.name).sortsOnHost) info.released = &scene;
  impl_ = std::make_unique<Impl>(gpu, scene, info, method);
}

StillRenderer::StillRenderer(Gpu& gpu, const Scene& scene, std::optional<float> opacity, const MethodOptions& method,
                             std::uint32_t framesInFlight)
    : impl_(std::make_unique<Impl>(
          gpu, scene, StageInfo{opacity, DrawOrder::Forward, method.samples, nullptr, framesInFlight}, method)) {}

StillRenderer::~StillRenderer() = default;

Stage& StillRenderer::stage() { return impl_->stage; }
Method& StillRenderer::method() { return *impl_->method; }
void StillRenderer::setSize(VkExtent2D size) { impl_->setSize(size); }
MethodTarget StillRenderer::targetOf(const RenderOptions& picture) { return impl_->targetOf(picture); }
std::vector<std::string> StillRenderer::warningsOf(const RenderOptions& picture, const FrameStats& stats) const {
  return impl_->warningsOf(picture, stats);
}

RenderResult StillRenderer::render(const RenderOptions& options) {
  RenderResult result;
  result.report = impl_->drawUntilComplete(options, true);
  const bool hasAlpha = options.background.kind == Background::Kind::Transparent;
  if (options.encoding == Encoding::Srgb8) {
    result.picture = {options.width, options.height, hasAlpha, impl_->encode.pixels()};
  } else {
    result.deep = {options.width, options.height, hasAlpha, options.encoding, impl_->encode.deepPixels()};
  }
  result.isEmpty = impl_->isBackgroundAlone(options, result);
  return result;
}

FrameReport StillRenderer::measure(const RenderOptions& options) { return impl_->drawUntilComplete(options, false); }

} // namespace vitrail::tool
