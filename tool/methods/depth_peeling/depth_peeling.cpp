// Depth peeling, front to back: Everitt, "Interactive Order-Independent Transparency" (NVIDIA 2001). Each pass draws
// all surfaces, leaves out those that earlier passes took, and keeps the nearest of the rest by the depth test; it is
// then blended under the layers before it. As many passes as the deepest pixel has surfaces, which is measured
// (depth_complexity.h), or fewer: then the nearest are drawn and the rest is missing, which the report says.
//
// Surfaces of one pixel at equal depths, which peeling by depth alone takes for one, are told apart by the number of
// their triangle: none is lost.
//
// Cost: n draws of the surfaces for n layers in the deepest pixel, as many times all fragments through the depth test;
// what has textures is shaded in each, since neighbours take derivatives. Seven images of the picture's size, 68 bytes
// a pixel, however many layers there are. One sample a pixel.
//
// What it gets wrong: of surfaces at equal depths the one that is drawn first counts as nearer, so there, and only
// there, the order of submission shows. Each layer is kept in 16-bit floats.
#include <algorithm>
#include <memory>

#include "../../gpu/accesses.h"
#include "../../gpu/pixel_pass.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/depth_complexity.h"
#include "../shared/device_needs.h"
#include "../shared/peeling_shared.h"
#include "shaders/depth_peeling.frag.h"
#include "shaders/depth_peeling_blend.comp.h"

namespace vitrail::tool {

namespace {

constexpr VkFormat kTakenFormat = VK_FORMAT_R32G32_UINT;
constexpr VkFormat kFrontFormat = VK_FORMAT_R32G32B32A32_SFLOAT; // many layers would add up the rounding of 16 bits
constexpr VkFormat kLayerDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr std::uint64_t kPixelBytes = 4 * 8 + 2 * 16 + 4;

SurfacePipelines makePeel(const MethodHost& host, VkDescriptorSetLayout set) {
  requireDevice(host.gpu, "depth-peeling");
  const auto describe = [](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = shaders::depth_peeling_frag;
    info.colors = {{PictureImages::kColorFormat, {}}, {PictureImages::kColorFormat, {}}, {kTakenFormat, {}}};
    info.depthFormat = kLayerDepthFormat;
    info.depthTest = VK_COMPARE_OP_GREATER; // of surfaces at one depth the first remains, the others' turns come later
    info.depthWrite = true;
  };
  return {host.surfaces,
          host.surfaces.scene().transparentDraws(),
          {.set = set, .constantBytes = sizeof(std::uint32_t), .name = "depth-peeling"},
          describe};
}

class DepthPeeling final : public Method {
 public:
  DepthPeeling(const MethodHost& host, const MethodOptions& options);

  ImageNeeds needs() const override { return DepthComplexity::kNeeds; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  FrameStats stats() const override;

 private:
  void clear(Frame& frame);
  void peel(Frame& frame);
  void blend(Frame& frame, std::uint32_t step);

  Gpu& gpu_;
  std::uint32_t layers_; // 0: all
  DepthComplexity complexity_;
  SingleSet peelSet_;
  SingleSet blendSet_;
  SurfacePipelines surfaces_;
  PixelPass blend_;
  VkExtent2D extent_{};
  UsedImage depth_; // of the layer that a pass takes
  UsedImage color_;
  UsedImage opacity_;
  UsedImage layerTaken_;
  UsedImage frontColor_; // of the layers before it
  UsedImage frontThrough_;
  UsedImage taken_;
};

DepthPeeling::DepthPeeling(const MethodHost& host, const MethodOptions& options)
    : gpu_(host.gpu),
      layers_(options.maxLayers),
      complexity_(host, "depth-peeling"),
      peelSet_(gpu_,
               {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT},  // opaque depth
                {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT}}, // taken
               "depth-peeling"),
      blendSet_(gpu_, {7, {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}}, "depth-peeling blend"),
      surfaces_(makePeel(host, peelSet_.layout())),
      blend_(gpu_, blendSet_,
             {.shader = shaders::depth_peeling_blend_comp,
              .name = "depth-peeling blend",
              .constantBytes = sizeof(std::uint32_t)}) {}

void DepthPeeling::setTarget(const MethodTarget& target) {
  extent_ = target.extent;
  complexity_.setTarget(target);
  GpuImageInfo info;
  info.extent = extent_;
  info.format = kLayerDepthFormat;
  info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  info.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  depth_.ensure(gpu_, info, "layer depth");
  info.aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  const auto make = [&](UsedImage& image, VkFormat format, VkImageUsageFlags usage, const char* name) {
    info.format = format;
    info.usage = VK_IMAGE_USAGE_STORAGE_BIT | usage;
    image.ensure(gpu_, info, name);
  };
  make(color_, PictureImages::kColorFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, "layer colour");
  make(opacity_, PictureImages::kColorFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, "layer opacity");
  make(layerTaken_, kTakenFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, "layer depth and triangle");
  make(frontColor_, kFrontFormat, VK_IMAGE_USAGE_TRANSFER_DST_BIT, "colour of nearer layers");
  make(frontThrough_, kFrontFormat, VK_IMAGE_USAGE_TRANSFER_DST_BIT, "transmittance of nearer layers");
  make(taken_, kTakenFormat, VK_IMAGE_USAGE_TRANSFER_DST_BIT, "last depth and triangle");
  peelSet_.writeImage(0, target.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  peelSet_.writeImage(1, taken_.get().view(), VK_IMAGE_LAYOUT_GENERAL);
  const UsedImage* images[] = {&color_, &opacity_, &layerTaken_, &frontColor_, &frontThrough_, &taken_};
  std::uint32_t binding = 0;
  for (const UsedImage* image : images) blendSet_.writeImage(binding++, image->get().view(), VK_IMAGE_LAYOUT_GENERAL);
  blendSet_.writeImage(binding, target.color, VK_IMAGE_LAYOUT_GENERAL);
}

void DepthPeeling::releaseTarget() {
  complexity_.releaseTarget();
  for (UsedImage* image : {&depth_, &color_, &opacity_, &layerTaken_, &frontColor_, &frontThrough_, &taken_}) {
    *image = UsedImage();
  }
}

void DepthPeeling::draw(Frame& frame) {
  complexity_.measure(frame, layers_);
  const std::uint32_t deepest = complexity_.deepest();
  const std::uint32_t passes = layers_ > 0 ? std::min(layers_, deepest) : deepest;
  if (passes == 0) return;
  clear(frame);
  for (std::uint32_t pass = 0; pass < passes; ++pass) {
    peel(frame);
    frame.endPass("peel");
    blend(frame, shaders::PEELING_NEXT);
    frame.endPass("compose");
    if ((pass + 1) % DepthComplexity::kRounds == 0) frame.submitAndWait();
  }
  blend(frame, shaders::PEELING_LAST);
  frame.endPass("compose");
}

void DepthPeeling::clear(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  VkClearColorValue value{};
  frontColor_.cmdClear(commands, value);
  std::fill_n(value.float32, 4, 1.0F);
  frontThrough_.cmdClear(commands, value);
  std::fill_n(value.uint32, 4, UINT32_MAX); // nearer than all
  taken_.cmdClear(commands, value);
  // The opaque draws wrote the picture -> the last step reads and writes it.
  frame.images().color().cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeReadWrite);
}

void DepthPeeling::peel(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  // The surfaces were counted, and the last layer blended -> the fragments of this pass read what they are held to.
  frame.images().depth().cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, kFragmentSample);
  taken_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kFragmentRead);
  Scope scope = frame.images().wholeScope();
  const VkClearColorValue nothing{};
  for (UsedImage* image : {&color_, &opacity_, &layerTaken_}) {
    image->discard();
    scope.colors.push_back({.image = image, .clear = nothing});
  }
  depth_.discard();
  scope.depth = {.image = &depth_, .depth = AspectUse::Write, .clear = VkClearDepthStencilValue{0.0F, 0}};
  cmdBeginScope(commands, scope);
  std::uint32_t firstTriangle = 0;
  for (const SurfaceRun& run : frame.surfaces().transparentRuns()) {
    vkCmdPushConstants(commands, surfaces_.layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(firstTriangle),
                       &firstTriangle);
    frame.drawSurfaces(surfaces_, peelSet_.set(), std::span(&run, 1));
    firstTriangle += run.indexCount / 3;
  }
  vkCmdEndRendering(commands);
}

void DepthPeeling::blend(Frame& frame, std::uint32_t step) {
  VkCommandBuffer commands = frame.commands();
  // The pass wrote a layer -> it is read.
  for (UsedImage* image : {&color_, &opacity_, &layerTaken_}) {
    image->cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeRead);
  }
  // The layer before it was blended, and the pass read what was taken -> they are read and written again.
  frontColor_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeReadWrite);
  frontThrough_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeReadWrite);
  taken_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeWrite);
  blend_.cmdRun(commands, extent_, &step);
}

FrameStats DepthPeeling::stats() const {
  FrameStats stats = complexity_.stats();
  stats.totalBytes += kPixelBytes * extent_.width * extent_.height;
  return stats;
}

} // namespace

std::unique_ptr<Method> makeDepthPeeling(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<DepthPeeling>(host, options);
}

} // namespace vitrail::tool
