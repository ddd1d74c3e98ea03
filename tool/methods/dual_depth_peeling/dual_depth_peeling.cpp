// Dual depth peeling: Bavoil and Myers, "Order Independent Transparency with Dual Depth Peeling" (NVIDIA 2008). Each
// pass takes the nearest and the farthest layer that is left, at depths that the pass before it found by MAX blending
// of (z, -z) in two channels. The nearer one is blended under the front, the farther one over the back. As many
// passes as the deepest pixel needs, which is measured (depth_complexity.h).
//
// Cost: 1 + n / 2 draws of the surfaces for n layers in the deepest pixel, each of which writes five attachments; what
// has textures is shaded in each, since neighbours take derivatives. Nine images of the picture's size, 96 bytes a
// pixel, however many layers there are. One sample a pixel.
//
// What it gets wrong: surfaces of one pixel at equal depths are one layer. Here their colours are added and their
// opacities united, instead of the MAX of the paper, which loses all but one; the sum is then scaled as if they were
// equal, which is exact where they are and evens them out where they are not. The order of submission does not show.
// Each layer is kept in 16-bit floats.
#include <algorithm>
#include <array>
#include <memory>

#include "../../gpu/accesses.h"
#include "../../gpu/pixel_pass.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/depth_complexity.h"
#include "../shared/device_needs.h"
#include "../shared/peeling_shared.h"
#include "shaders/dual_depth_peeling.frag.h"
#include "shaders/dual_depth_peeling_blend.comp.h"

namespace vitrail::tool {

namespace {

constexpr VkFormat kFoundFormat = VK_FORMAT_R32G32_SFLOAT;
constexpr VkFormat kSumFormat = VK_FORMAT_R32G32B32A32_SFLOAT; // many layers would add up the rounding of 16 bits
constexpr std::uint32_t kAttachments = 5;
constexpr std::uint64_t kDualPixelBytes = 6 * 8 + 3 * 16;

// Throws GpuError where the device cannot blend what a pass writes.
Gpu& withBlending(Gpu& gpu) {
  requireDevice(gpu, "dual-depth-peeling");
  return gpu;
}

SurfacePipelines makeDualPeel(const MethodHost& host, VkDescriptorSetLayout set) {
  const auto describe = [](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    const BlendFactors add{VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE};
    auto most = blendWith(add, add);
    most.colorBlendOp = most.alphaBlendOp = VK_BLEND_OP_MAX;
    const auto sum = blendWith(add, add);
    const BlendFactors both{VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR};
    const auto united = blendWith(both, {VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA});
    info.fragmentShader = shaders::dual_depth_peeling_frag;
    info.colors = {{kFoundFormat, most},
                   {PictureImages::kColorFormat, sum},
                   {PictureImages::kColorFormat, united},
                   {PictureImages::kColorFormat, sum},
                   {PictureImages::kColorFormat, united}};
    info.depthFormat = PictureImages::depthFormat(true);
  };
  return {
      host.surfaces, host.surfaces.scene().transparentDraws(), {.set = set, .name = "dual-depth-peeling"}, describe};
}

SingleSet makePeelSet(Gpu& gpu) {
  return {gpu, {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT}}, "found depths"};
}

VkClearColorValue all(float value) {
  VkClearColorValue clear{};
  std::fill_n(clear.float32, 4, value);
  return clear;
}

class DualDepthPeeling final : public Method {
 public:
  explicit DualDepthPeeling(const MethodHost& host);

  ImageNeeds needs() const override { return DepthComplexity::kNeeds; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  FrameStats stats() const override;

 private:
  void clear(Frame& frame);
  void peel(Frame& frame, std::uint32_t pass);
  void blend(Frame& frame, std::uint32_t step);

  Gpu& gpu_;
  DepthComplexity complexity_;
  std::array<SingleSet, 2> peelSets_; // of each of the depths below, as what the last pass found
  SingleSet blendSet_;
  SurfacePipelines surfaces_;
  PixelPass blend_;
  VkExtent2D extent_{};
  std::array<UsedImage, 2> found_;  // by the last pass and the present one, in turns
  std::array<UsedImage, 4> layers_; // the nearer one's colour and opacity, the farther one's
  UsedImage back_;                  // the picture and all farther layers
  std::array<UsedImage, 2> front_;  // colour and transmittance of all nearer layers
};

DualDepthPeeling::DualDepthPeeling(const MethodHost& host)
    : gpu_(withBlending(host.gpu)),
      complexity_(host, "dual-depth-peeling"),
      peelSets_{makePeelSet(gpu_), makePeelSet(gpu_)},
      blendSet_(gpu_, {8, {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}}, "dual-depth-peeling blend"),
      surfaces_(makeDualPeel(host, peelSets_[0].layout())),
      blend_(gpu_, blendSet_,
             {.shader = shaders::dual_depth_peeling_blend_comp,
              .name = "dual-depth-peeling blend",
              .constantBytes = sizeof(std::uint32_t)}) {}

void DualDepthPeeling::setTarget(const MethodTarget& target) {
  extent_ = target.extent;
  complexity_.setTarget(target);
  GpuImageInfo info;
  info.extent = extent_;
  info.format = kFoundFormat;
  info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  for (std::size_t i = 0; i < found_.size(); ++i) {
    found_[i].ensure(gpu_, info, "found depths");
    peelSets_[i].writeImage(0, found_[i].get().view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  }
  info.format = PictureImages::kColorFormat;
  info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
  std::uint32_t binding = 0;
  for (UsedImage& layer : layers_) {
    layer.ensure(gpu_, info, "layer");
    blendSet_.writeImage(binding++, layer.get().view(), VK_IMAGE_LAYOUT_GENERAL);
  }
  info.format = kSumFormat;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  for (UsedImage& front : front_) {
    front.ensure(gpu_, info, "nearer layers");
    blendSet_.writeImage(binding++, front.get().view(), VK_IMAGE_LAYOUT_GENERAL);
  }
  back_.ensure(gpu_, info, "farther layers");
  blendSet_.writeImage(binding++, back_.get().view(), VK_IMAGE_LAYOUT_GENERAL);
  blendSet_.writeImage(binding, target.color, VK_IMAGE_LAYOUT_GENERAL);
}

void DualDepthPeeling::releaseTarget() {
  complexity_.releaseTarget();
  for (UsedImage& image : found_) image = UsedImage();
  for (UsedImage& image : layers_) image = UsedImage();
  for (UsedImage& image : front_) image = UsedImage();
  back_ = UsedImage();
}

// The first pass finds depths, and each after it takes two layers.
void DualDepthPeeling::draw(Frame& frame) {
  complexity_.measure(frame);
  const std::uint32_t pairs = (complexity_.deepest() + 1) / 2;
  if (pairs == 0) return;
  clear(frame);
  peel(frame, 0);
  frame.endPass("peel");
  for (std::uint32_t pass = 1; pass <= pairs; ++pass) {
    peel(frame, pass);
    frame.endPass("peel");
    blend(frame, pass == 1 ? shaders::PEELING_FIRST : shaders::PEELING_NEXT);
    frame.endPass("compose");
    if (pass % DepthComplexity::kRounds == 0) frame.submitAndWait();
  }
  blend(frame, shaders::PEELING_LAST);
  frame.endPass("compose");
}

void DualDepthPeeling::clear(Frame& frame) {
  front_[0].cmdClear(frame.commands(), all(0.0F));
  front_[1].cmdClear(frame.commands(), all(1.0F));
  found_[1].cmdClear(frame.commands(), all(2.0F)); // all surfaces are between these
}

void DualDepthPeeling::peel(Frame& frame, std::uint32_t pass) {
  UsedImage& last = found_[(pass + 1) % 2];
  UsedImage& found = found_[pass % 2];
  // The last pass found depths -> the fragments of this one read them.
  last.cmdUse(frame.commands(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kFragmentSample);
  Scope scope = frame.images().wholeScope();
  found.discard();
  scope.colors.push_back({.image = &found, .clear = all(-2.0F)}); // beyond all depths
  for (UsedImage& layer : layers_) {
    layer.discard();
    scope.colors.push_back({.image = &layer, .clear = all(0.0F)});
  }
  scope.depth = {.image = &frame.images().depth(), .depth = AspectUse::Test};
  cmdBeginScope(frame.commands(), scope);
  frame.drawSurfaces(surfaces_, peelSets_[(pass + 1) % 2].set());
  vkCmdEndRendering(frame.commands());
}

void DualDepthPeeling::blend(Frame& frame, std::uint32_t step) {
  VkCommandBuffer commands = frame.commands();
  // The pass wrote two layers -> they are read.
  for (UsedImage& layer : layers_) layer.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeRead);
  // The layers before them were blended -> so are these.
  for (UsedImage& front : front_) front.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeReadWrite);
  back_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeReadWrite);
  if (step != shaders::PEELING_NEXT) {
    // The opaque draws wrote the picture -> the first step reads it, and the last one writes it.
    frame.images().color().cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeReadWrite);
  }
  blend_.cmdRun(commands, extent_, &step);
}

FrameStats DualDepthPeeling::stats() const {
  FrameStats stats = complexity_.stats();
  stats.totalBytes += kDualPixelBytes * extent_.width * extent_.height;
  return stats;
}

} // namespace

std::unique_ptr<Method> makeDualDepthPeeling(const MethodHost& host, const MethodOptions& /*options*/) {
  return std::make_unique<DualDepthPeeling>(host);
}

} // namespace vitrail::tool
