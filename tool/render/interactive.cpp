#include "interactive.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "../methods/methods.h"
#include "../stage/frame.h"
#include "attempts.h"

namespace vitrail::tool {

bool InteractiveRenderer::draws(const MethodOptions& method) {
  return method.api == Api::Vulkan && (method.name == kListMethod || method.name == kTilesMethod);
}

InteractiveRenderer::InteractiveRenderer(Gpu& gpu, const Scene& scene, std::optional<float> opacity,
                                         const MethodOptions& method)
    : gpu_(gpu),
      method_(method),
      still_(gpu, scene, opacity, method, kFramesInFlight),
      facts_(drawFactsOf(scene)),
      encode_(gpu) {
  for (std::uint32_t i = 0; i < kFramesInFlight; ++i) slots_.push_back(std::make_unique<Slot>(gpu));
}

InteractiveRenderer::~InteractiveRenderer() {
  slots_.clear(); // which wait for what is pending
}

// Waits for a picture, and takes note of what was counted while the method has it.
void InteractiveRenderer::settle(Pending& pending) {
  if (pending.stats) return;
  pending.slot->submitter.wait();
  pending.stats = still_.method().statsOf(pending.picture);
}

void InteractiveRenderer::settleAll() {
  for (Pending& pending : pending_) settle(pending);
}

void InteractiveRenderer::setSize(VkExtent2D size) {
  Stage& stage = still_.stage();
  if (!stage.hasSize(size)) {
    settleAll();
    still_.setSize(size);
  }
  if (outputImages_ == stage.imagesMade()) return;
  outputs_.clear(); // those that are shown stay
  outputImages_ = stage.imagesMade();
}

// One that nobody holds. There are as many as were ever held at once, and one.
std::shared_ptr<EncodeImagePass::Output> InteractiveRenderer::freeOutput() {
  for (const std::shared_ptr<EncodeImagePass::Output>& output : outputs_) {
    if (output.use_count() == 1) return output;
  }
  return outputs_.emplace_back(encode_.makeOutput(still_.stage().images().color().get()));
}

bool InteractiveRenderer::draw(const RenderOptions& options, VkExtent2D size, bool readsBack) {
  checkPictureOptions(method_, options.memoryBudget.has_value(), options.peel > 0);
  // To find out again would make its pipelines anew, and render() those of its own, for each picture.
  const auto asked = std::tuple(size.width, size.height, options.memoryBudget);
  if (noRoom_ == asked) return false;
  setSize(size);
  Stage& stage = still_.stage();
  Method& method = still_.method();
  PictureImages& images = stage.images();
  const VkExtent2D part{options.width, options.height};
  images.setPart(part);
  stage.setView(options.view);
  MethodTarget target = still_.targetOf(options);
  target.framesInFlight = kFramesInFlight;
  target.waitForFrames = [this] { settleAll(); };
  method.setTarget(target);
  if (!method.drawsInFlight()) {
    noRoom_ = asked;
    return false;
  }

  Slot& slot = *slots_[next_];
  next_ = (next_ + 1) % slots_.size();
  Pending pending{&slot, freeOutput(), options, 0, readsBack, {}};
  if (const std::uint64_t bytes = std::uint64_t{part.width} * part.height * 4;
      readsBack && slot.pixels.size() < bytes) {
    slot.pixels = {};
    slot.pixels = GpuBuffer(gpu_, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Readback, "shown pixels");
  }
  Frame frame(slot.submitter, slot.timers, images, stage.surfaces());
  stage.drawOpaque(frame, options.background);
  method.draw(frame);
  pending.picture = method.lastPicture();
  stage.finishPicture(frame);
  images.cmdToEncode(frame.commands());
  encode_.cmdEncode(frame.commands(), *pending.output, part, readsBack ? slot.pixels.get() : VK_NULL_HANDLE);
  frame.endPass("encode");
  frame.submit();
  pending_.push_back(std::move(pending));
  return true;
}

InteractivePicture InteractiveRenderer::finish() {
  Pending pending = std::move(pending_.front());
  pending_.pop_front();
  Slot& slot = *pending.slot;
  settle(pending);
  slot.timers.addSubmission();
  InteractivePicture picture;
  picture.part = {pending.options.width, pending.options.height};
  if (pending.readsBack) {
    picture.pixels.resize(std::size_t{picture.part.width} * picture.part.height * 4);
    std::memcpy(picture.pixels.data(), slot.pixels.mapped(), picture.pixels.size());
  }
  picture.report = reportOf(*pending.stats, pending.options, method_, slot.timers.milliseconds());
  picture.report.device = gpu_.properties().deviceName;
  picture.report.api = kVulkanApi;
  picture.report.warnings = still_.warningsOf(pending.options, *pending.stats);
  picture.report.peakBytes = gpu_.peakMemory();
  const GpuImage* image = &pending.output->image;
  picture.image = std::shared_ptr<const GpuImage>(std::move(pending.output), image);
  return picture;
}

std::optional<std::vector<PickedLayer>> InteractiveRenderer::pick(const RenderOptions& options, std::uint32_t x,
                                                                  std::uint32_t y) {
  still_.stage().setView(options.view, {options.width, options.height});
  if (!picker_) picker_.emplace(still_.stage().surfaces(), facts_);
  return picker_->at(options.view, options.width, options.height, x, y);
}

RenderResult InteractiveRenderer::render(const RenderOptions& options) { return still_.render(options); }

FrameReport InteractiveRenderer::measure(const RenderOptions& options) { return still_.measure(options); }

} // namespace vitrail::tool
