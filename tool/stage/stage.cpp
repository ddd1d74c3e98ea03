#include "stage.h"

#include <fmt/format.h>

#include "../gpu/screen_pass.h"
#include "../scene/srgb.h"
#include "frame_data.h"
#include "shaders/opaque.frag.h"
#include "shaders/sky.frag.h"

namespace vitrail::tool {

namespace {

VkClearColorValue clearColor(const Background& background) {
  VkClearColorValue value{};
  if (background.kind != Background::Kind::Color) return value;
  const glm::vec3 linear = linearFromSrgb(background.srgb);
  for (int i = 0; i < 3; ++i) value.float32[i] = linear[i];
  value.float32[3] = 1.0F;
  return value;
}

VkSampleCountFlagBits sampleFlag(const Gpu& gpu, std::uint32_t samples) {
  const VkSampleCountFlags offered = gpu.features().sampleCounts;
  if ((offered & samples) == 0) {
    throw GpuError(fmt::format("{} draws {} samples a pixel, not {}: choose one of these with --samples",
                               gpu.properties().deviceName, sampleCountsText(offered), samples));
  }
  return flagOf(samples);
}

GraphicsPipelineInfo skyPipeline(VkPipelineLayout layout, const PictureImagesInfo& images) {
  GraphicsPipelineInfo info = screenPipeline(layout, shaders::sky_frag, "sky");
  info.samples = images.samples;
  info.colors = {{PictureImages::kColorFormat, {}}};
  info.depthFormat = PictureImages::depthFormat(images.stencil);
  return info;
}

SurfacePipelines opaquePipelines(const Surfaces& surfaces, const PictureImagesInfo& images) {
  const auto describe = [&](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = shaders::opaque_frag;
    info.samples = images.samples;
    info.colors = {{PictureImages::kColorFormat, {}}};
    info.depthFormat = PictureImages::depthFormat(images.stencil);
    info.depthWrite = true;
  };
  return {surfaces, surfaces.scene().opaqueDraws(), {.name = "opaque"}, describe};
}

} // namespace

Stage::Stage(Gpu& gpu, const Scene& scene, const StageInfo& info)
    : gpu_(gpu),
      imagesInfo_{{}, {}, sampleFlag(gpu, info.samples)},
      surfaces_(gpu, scene, info.opacity, info.order, info.released, info.framesInFlight) {}

void Stage::setNeeds(const ImageNeeds& needs) {
  static_cast<ImageNeeds&>(imagesInfo_) = needs;
  SurfacePipelines surfaces = opaquePipelines(surfaces_, imagesInfo_);
  Unique<VkPipeline> sky = makeGraphicsPipeline(gpu_, skyPipeline(surfaces.layout(), imagesInfo_));
  opaque_.emplace(OpaquePass{std::move(surfaces), std::move(sky)});
}

bool Stage::hasSize(VkExtent2D extent) const {
  return extent.width == images_.size().width && extent.height == images_.size().height;
}

void Stage::setSize(VkExtent2D extent) {
  images_ = PictureImages(); // first: the old size and the new one need not fit together
  imagesInfo_.extent = extent;
  images_ = PictureImages(gpu_, imagesInfo_);
  ++imagesMade_;
}

void Stage::setView(const View& view) { setView(view, images_.extent()); }

void Stage::setView(const View& view, VkExtent2D extent) {
  surfaces_.setView(makeFrameData(view, extent.width, extent.height, surfaces_.scene().origin()));
}

// Begins the opaque scope and draws the background.
void Stage::cmdBegin(VkCommandBuffer commands, const Background& background) {
  images_.cmdBeginOpaque(commands, clearColor(background));
  if (background.kind == Background::Kind::Sky) {
    surfaces_.cmdBindView(commands, opaque_->surfaces.layout());
    cmdDrawScreen(commands, opaque_->sky.get());
  }
}

void Stage::drawBackground(Frame& frame, const Background& background) {
  cmdBegin(frame.commands(), background);
  vkCmdEndRendering(frame.commands());
  if (imagesInfo_.samples > VK_SAMPLE_COUNT_1_BIT) images_.cmdBoxFilter(frame.commands());
  frame.endPass("background");
}

void Stage::drawOpaque(Frame& frame, const Background& background) {
  VkCommandBuffer commands = frame.commands();
  cmdBegin(commands, background);
  const std::vector<GpuDraw>& draws = surfaces_.scene().opaqueDraws();
  surfaces_.cmdDraw(commands, draws, runsOf(draws), opaque_->surfaces);
  vkCmdEndRendering(commands);
  frame.endPass("opaque");
}

void Stage::finishPicture(Frame& frame) {
  if (!imagesInfo_.perSample || imagesInfo_.samples == VK_SAMPLE_COUNT_1_BIT) return;
  images_.cmdBoxFilter(frame.commands());
  frame.endPass("box_filter");
}

} // namespace vitrail::tool
