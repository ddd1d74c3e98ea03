// The stencil-routed A-buffer: Myers and Bavoil, "Stencil Routed A-Buffer" (SIGGRAPH 2007 sketches). The fragments of a
// pixel go to the samples of a multisampled image. All samples see all fragments; the stencil of each counts down from
// a number of its own, and lets the sample be written until the fragment that it is for has come. When all surfaces
// have been drawn the samples are sorted and blended. As many layers a pass as the device has samples, up to 8, and as
// many passes as the deepest pixel needs, which is measured (depth_complexity.h), each with other numbers.
//
// All samples of a pixel must be covered by what covers its middle. The method was made with multisampling switched off
// while drawing into multisampled images, which Vulkan has not; VK_EXT_sample_locations puts all samples into the
// middle instead. Where the device lacks it each sample is drawn by itself, with the scene moved so that the middle of
// the pixel falls on the sample.
//
// Cost: n / s draws of the surfaces for n layers in the deepest pixel and s samples, or n where samples are drawn by
// themselves, each fragment shaded once in each until all samples that it reaches are full; 28 s bytes a pixel for the
// samples and 20 n for the layers of all passes; the blending of n fragments reads them n / 16 times. One sample a
// pixel in the picture.
//
// What it gets wrong: a stencil counts to 255, so more than 254 surfaces in a pixel are refused. Each layer is kept in
// 16-bit floats. Where samples are drawn by themselves the moved scene may be rounded otherwise, so a pixel whose
// middle is as good as on an edge may lose or repeat a fragment, and a slanting decal in the very plane of an opaque
// surface is lost in places: such pictures are reported as not exact.
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "../../gpu/accesses.h"
#include "../../gpu/pixel_pass.h"
#include "../../gpu/screen_pass.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/depth_complexity.h"
#include "../shared/device_needs.h"
#include "shaders/stencil_routed.frag.h"
#include "shaders/stencil_routed_begin.frag.h"
#include "shaders/stencil_routed_blend.comp.h"
#include "shaders/stencil_routed_each.frag.h"
#include "shaders/stencil_routed_keep.comp.h"

namespace vitrail::tool {

namespace {

constexpr std::array<VkFormat, 3> kFormats{PictureImages::kColorFormat, PictureImages::kColorFormat,
                                           VK_FORMAT_R32_SFLOAT};
constexpr std::uint64_t kStencilLayerBytes = 8 + 8 + 4;
constexpr std::uint64_t kDepthBytes = 8;
constexpr std::uint32_t kMostLayers = 254;

// A sample whose stencil is at or above this is still to be written; the fragment that finds it here is the sample's.
constexpr std::uint32_t kWaiting = 2;

struct KeepConstants {
  std::uint32_t firstLayer;
  std::uint32_t samples;
};

// The most of the offered counts; 1: there are no several.
std::uint32_t mostSamples(VkSampleCountFlags offered) {
  for (const std::uint32_t count : {8U, 4U, 2U}) {
    if ((offered & count) != 0) return count; // a flag's value is its count
  }
  return 1;
}

std::uint32_t samplesOf(const Gpu& gpu, bool inMiddle) {
  const std::uint32_t samples = mostSamples(inMiddle ? gpu.features().middleSamples : gpu.features().sampleCounts);
  if (!inMiddle) requireDevice(gpu, "stencil-routed");
  return samples;
}

// The standard places of samples in a pixel, in 1/16 from its corner (Vulkan specification, "Multisampling").
std::array<float, 2> standardPlace(std::uint32_t samples, std::uint32_t sample) {
  using Places = std::array<std::array<float, 2>, 8>;
  constexpr Places k2{{{12, 12}, {4, 4}}};
  constexpr Places k4{{{6, 2}, {14, 6}, {2, 10}, {10, 14}}};
  constexpr Places k8{{{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}}};
  const Places& places = samples == 2 ? k2 : samples == 4 ? k4 : k8;
  return places.at(sample);
}

VkStencilOpState stencil(VkCompareOp compare, VkStencilOp pass) {
  return {.failOp = VK_STENCIL_OP_KEEP,
          .passOp = pass,
          .depthFailOp = VK_STENCIL_OP_KEEP,
          .compareOp = compare,
          .compareMask = 0xff,
          .writeMask = 0xff,
          .reference = kWaiting};
}

class StencilRouted final : public Method {
 public:
  explicit StencilRouted(const MethodHost& host);

  ImageNeeds needs() const override { return DepthComplexity::kNeeds; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  FrameStats stats() const override;

 private:
  GraphicsPipelineInfo beginPipeline(const std::string& name) const;
  SurfacePipelines makeSurfaces(const MethodHost& host, std::uint32_t sampleMask) const;
  void makeLayers(std::uint32_t count);
  void route(Frame& frame, std::uint32_t firstLayer);
  void drawSamples(Frame& frame);
  void keep(Frame& frame, std::uint32_t firstLayer);
  void blend(Frame& frame);

  Gpu& gpu_;
  bool inMiddle_;         // the samples, all of them
  std::uint32_t samples_; // of a pixel
  DepthComplexity complexity_;
  SingleSet beginSet_;
  SingleSet layersSet_; // of the passes that keep and blend layers
  Unique<VkPipelineLayout> beginLayout_;
  Unique<VkPipeline> beginDepth_;
  std::vector<Unique<VkPipeline>> beginStencil_; // adds 1 to all samples but the first, the first two, ...
  std::vector<SurfacePipelines> surfaces_;       // of all samples, or of each
  PixelPass keep_;
  PixelPass blend_;
  VkExtent2D extent_{};
  UsedImage depth_;                  // with the stencil
  std::array<UsedImage, 3> sampled_; // colour, opacity and depth, of the samples
  std::array<UsedImage, 3> layers_;  // the same of all passes
};

StencilRouted::StencilRouted(const MethodHost& host)
    : gpu_(host.gpu),
      inMiddle_(mostSamples(gpu_.features().middleSamples) > 1),
      samples_(samplesOf(gpu_, inMiddle_)),
      complexity_(host, "stencil-routed"),
      beginSet_(gpu_, {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT}}, "stencil-routed begin"),
      layersSet_(gpu_,
                 {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
                  {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
                  {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
                  {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
                  {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
                  {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
                  {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},  // counts of surfaces
                  {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}}, // the picture
                 "stencil-routed layers"),
      beginLayout_(makePipelineLayout(gpu_, {beginSet_.layout()}, {}, "stencil-routed begin")),
      keep_(gpu_, layersSet_,
            {.shader = shaders::stencil_routed_keep_comp,
             .name = "stencil-routed keep",
             .constantBytes = sizeof(KeepConstants)}),
      blend_(gpu_, layersSet_, {.shader = shaders::stencil_routed_blend_comp, .name = "stencil-routed blend"}) {
  GraphicsPipelineInfo info = beginPipeline("stencil-routed begin depth");
  info.depthTest = VK_COMPARE_OP_ALWAYS;
  info.depthWrite = true;
  beginDepth_ = makeGraphicsPipeline(gpu_, info);
  for (std::uint32_t sample = 1; sample < samples_; ++sample) {
    info = beginPipeline("stencil-routed begin stencil");
    info.sampleMask = UINT32_MAX << sample;
    info.stencil = stencil(VK_COMPARE_OP_ALWAYS, VK_STENCIL_OP_INCREMENT_AND_CLAMP);
    beginStencil_.push_back(makeGraphicsPipeline(gpu_, info));
  }
  for (std::uint32_t sample = 0; sample < (inMiddle_ ? 1 : samples_); ++sample) {
    surfaces_.push_back(makeSurfaces(host, inMiddle_ ? UINT32_MAX : 1U << sample));
  }
}

// Over the whole picture, without colours.
GraphicsPipelineInfo StencilRouted::beginPipeline(const std::string& name) const {
  GraphicsPipelineInfo info = screenPipeline(beginLayout_.get(), shaders::stencil_routed_begin_frag, name);
  info.samples = flagOf(samples_);
  info.samplesInMiddle = inMiddle_;
  for (const VkFormat format : kFormats) info.colors.push_back({format, VkPipelineColorBlendAttachmentState{}});
  info.depthFormat = PictureImages::depthFormat(true);
  return info;
}

// The paper lets only the fragment through that a sample is for, and counts others where the stencil test fails. That
// also counts those that opaque surfaces hide, as the depth is not looked at where the stencil fails: here a sample is
// written over until its fragment has come.
SurfacePipelines StencilRouted::makeSurfaces(const MethodHost& host, std::uint32_t sampleMask) const {
  const auto describe = [&](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = shaders::stencil_routed_frag;
    if (!inMiddle_) info.fragmentShader = shaders::stencil_routed_each_frag;
    info.samples = flagOf(samples_);
    info.samplesInMiddle = inMiddle_;
    info.shadeEverySample = !inMiddle_;
    info.sampleMask = sampleMask;
    for (const VkFormat format : kFormats) info.colors.push_back({format, {}});
    info.depthFormat = PictureImages::depthFormat(true);
    info.stencil = stencil(VK_COMPARE_OP_LESS_OR_EQUAL, VK_STENCIL_OP_DECREMENT_AND_CLAMP);
  };
  return {host.surfaces, host.surfaces.scene().transparentDraws(), {.name = "stencil-routed"}, describe};
}

void StencilRouted::setTarget(const MethodTarget& target) {
  extent_ = target.extent;
  complexity_.setTarget(target);
  GpuImageInfo info;
  info.extent = extent_;
  info.samples = flagOf(samples_);
  info.format = PictureImages::depthFormat(true);
  info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  info.aspect = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
  info.flags = inMiddle_ ? VK_IMAGE_CREATE_SAMPLE_LOCATIONS_COMPATIBLE_DEPTH_BIT_EXT : 0;
  depth_.ensure(gpu_, info, "depth and stencil of samples");
  info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  info.aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  info.flags = 0;
  for (std::uint32_t i = 0; i < kFormats.size(); ++i) {
    info.format = kFormats[i];
    sampled_[i].ensure(gpu_, info, "samples");
    layersSet_.writeImage(i, sampled_[i].get().view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  }
  beginSet_.writeImage(0, target.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  layersSet_.writeImage(6, target.stencil, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  layersSet_.writeImage(7, target.color, VK_IMAGE_LAYOUT_GENERAL);
}

void StencilRouted::releaseTarget() {
  complexity_.releaseTarget();
  depth_ = UsedImage();
  for (UsedImage& image : sampled_) image = UsedImage();
  for (UsedImage& image : layers_) image = UsedImage();
}

// At least two, so that the views are of arrays. No command buffer that uses them is pending.
void StencilRouted::makeLayers(std::uint32_t count) {
  GpuImageInfo info;
  info.extent = extent_;
  info.arrayLayers = std::max(count, 2U);
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  for (std::uint32_t i = 0; i < kFormats.size(); ++i) {
    info.format = kFormats[i];
    layers_[i].ensure(gpu_, info, "layers");
    layersSet_.writeImage(3 + i, layers_[i].get().view(), VK_IMAGE_LAYOUT_GENERAL);
  }
}

void StencilRouted::draw(Frame& frame) {
  complexity_.measure(frame);
  const std::uint32_t deepest = complexity_.deepest();
  if (deepest == 0) return;
  if (deepest > kMostLayers) {
    throw GpuError(
        fmt::format("a pixel has {} transparent surfaces, and the method stencil-routed counts at most {} "
                    "in a stencil: use depth-peeling or linked-list",
                    deepest, kMostLayers));
  }
  const std::uint32_t passes = (deepest + samples_ - 1) / samples_;
  makeLayers(passes * samples_);
  for (UsedImage& image : layers_) image.discard();
  for (std::uint32_t pass = 0; pass < passes; ++pass) {
    route(frame, pass * samples_);
    frame.endPass("route");
    keep(frame, pass * samples_);
    frame.endPass("keep");
    if ((pass + 1) % DepthComplexity::kRounds == 0) frame.submitAndWait();
  }
  blend(frame);
  frame.endPass("compose");
}

// In one scope, so that depths of samples in the middle keep to one layout.
void StencilRouted::route(Frame& frame, std::uint32_t firstLayer) {
  VkCommandBuffer commands = frame.commands();
  // The surfaces were counted -> the opaque depth is read.
  frame.images().depth().cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, kFragmentSample);
  Scope scope = frame.images().wholeScope();
  for (UsedImage& image : sampled_) {
    image.discard();
    scope.colors.push_back({.image = &image, .clear = VkClearColorValue{}});
  }
  depth_.discard();
  scope.depth = {.image = &depth_,
                 .depth = AspectUse::Write,
                 .stencil = AspectUse::Write,
                 .clear = VkClearDepthStencilValue{0.0F, kWaiting + firstLayer}};
  cmdBeginScope(commands, scope);
  const VkDescriptorSet set = beginSet_.set();
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, beginLayout_.get(), 0, 1, &set, 0, nullptr);
  cmdDrawScreen(commands, beginDepth_.get());
  for (const Unique<VkPipeline>& pipeline : beginStencil_) cmdDrawScreen(commands, pipeline.get());
  drawSamples(frame);
  vkCmdEndRendering(commands);
}

void StencilRouted::drawSamples(Frame& frame) {
  for (std::uint32_t sample = 0; sample < surfaces_.size(); ++sample) {
    if (!inMiddle_) {
      const std::array<float, 2> place = standardPlace(samples_, sample);
      const VkViewport moved{place[0] / 16.0F - 0.5F,
                             place[1] / 16.0F - 0.5F,
                             static_cast<float>(extent_.width),
                             static_cast<float>(extent_.height),
                             0.0F,
                             1.0F};
      vkCmdSetViewport(frame.commands(), 0, 1, &moved);
    }
    frame.drawSurfaces(surfaces_[sample]);
  }
}

void StencilRouted::keep(Frame& frame, std::uint32_t firstLayer) {
  VkCommandBuffer commands = frame.commands();
  // The surfaces wrote samples -> they are read, and stored beside those of the passes before.
  for (UsedImage& image : sampled_) image.cmdUse(commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kComputeSample);
  for (UsedImage& image : layers_) image.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeWrite);
  const KeepConstants constants{firstLayer, samples_};
  keep_.cmdRun(commands, extent_, &constants);
}

void StencilRouted::blend(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  // The passes stored layers -> they are read.
  for (UsedImage& image : layers_) image.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeRead);
  frame.images().cmdToComputeResolve(commands);
  blend_.cmdRun(commands, extent_);
}

FrameStats StencilRouted::stats() const {
  FrameStats stats = complexity_.stats();
  stats.resolve = "compute";
  stats.complete = stats.complete && inMiddle_;
  const std::uint64_t pixels = std::uint64_t{extent_.width} * extent_.height;
  const std::uint32_t layers = layers_[0].get().info().arrayLayers;
  if (layers_[0].get().get() != VK_NULL_HANDLE) stats.nodesBytes = pixels * kStencilLayerBytes * layers;
  stats.totalBytes += stats.nodesBytes + pixels * samples_ * (kStencilLayerBytes + kDepthBytes);
  return stats;
}

} // namespace

std::unique_ptr<Method> makeStencilRouted(const MethodHost& host, const MethodOptions& /*options*/) {
  return std::make_unique<StencilRouted>(host);
}

} // namespace vitrail::tool
