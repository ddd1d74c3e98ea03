// Depth peeling, back to front: Thibieroz, "Robust Order-Independent Transparency via Reverse Depth Peeling in DirectX
// 10" (ShaderX6, 2008). Each pass finds the farthest depth in front of the layer before it, and blends the surfaces at
// that depth straight into the picture, by fixed function. As many passes as the deepest pixel has surfaces, which is
// measured (depth_complexity.h): a picture that stops early lacks its nearest layers, so there is no --layers.
//
// All surfaces of a pixel at equal depths are one layer and are blended in one pass: none is lost.
//
// Cost: 2 n draws of the surfaces for n layers in the deepest pixel, n of which find depths and shade masked surfaces
// only; the others shade each fragment once in the frame. Two depth images, 8 bytes a pixel, and no colour but the
// picture's. One sample a pixel.
//
// What it gets wrong: of surfaces at equal depths the one that is drawn last counts as nearer, so there, and only
// there, the order of submission shows. The picture's 16-bit floats round after each layer.
#include <array>
#include <memory>

#include "../../gpu/accesses.h"
#include "../../stage/surface_shared.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/depth_complexity.h"
#include "../shared/fixed_blending.h"
#include "shaders/reverse_depth_peeling.frag.h"
#include "shaders/reverse_depth_peeling_find.frag.h"
#include "shaders/reverse_depth_peeling_transmission.frag.h"

namespace vitrail::tool {

namespace {

constexpr VkFormat kReverseDepthFormat = VK_FORMAT_D32_SFLOAT;

SingleSet makeSet(Gpu& gpu) {
  return {gpu, {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT}}, "depth of the last layer"};
}

SurfacePipelines makeFind(const MethodHost& host, VkDescriptorSetLayout set) {
  const auto describe = [](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = shaders::reverse_depth_peeling_find_frag;
    info.depthFormat = kReverseDepthFormat;
    info.depthTest = VK_COMPARE_OP_LESS_OR_EQUAL;
    info.depthWrite = true;
  };
  return {host.surfaces,
          host.surfaces.scene().transparentDraws(),
          {.set = set, .constantBytes = sizeof(std::uint32_t), .name = "reverse-depth-peeling find"},
          describe};
}

SurfacePipelines makeBlend(const MethodHost& host, const MethodOptions& options, VkDescriptorSetLayout set) {
  const auto adjust = [](std::uint32_t features, GraphicsPipelineInfo& info) {
    info.fragmentShader = shaders::reverse_depth_peeling_frag;
    if ((features & shaders::FEATURE_TRANSMISSION) != 0) {
      info.fragmentShader = shaders::reverse_depth_peeling_transmission_frag;
    }
    info.depthFormat = kReverseDepthFormat;
    info.depthTest = VK_COMPARE_OP_EQUAL;
  };
  return makeBlendedSurfaces(
      host, options, {.set = set, .constantBytes = sizeof(std::uint32_t), .name = "reverse-depth-peeling"}, adjust);
}

class ReverseDepthPeeling final : public Method {
 public:
  ReverseDepthPeeling(const MethodHost& host, const MethodOptions& options);

  ImageNeeds needs() const override { return DepthComplexity::kNeeds; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  FrameStats stats() const override;

 private:
  void find(Frame& frame, UsedImage& last, UsedImage& found, VkDescriptorSet lastSet);
  void blend(Frame& frame, UsedImage& found, VkDescriptorSet lastSet);
  void drawSurfaces(Frame& frame, const SurfacePipelines& pipelines, VkDescriptorSet lastSet) const;

  Gpu& gpu_;
  DepthComplexity complexity_;
  std::array<SingleSet, 2> sets_; // of each of the depths below, as the last layer's
  SingleSet opaqueSet_;           // of the opaque scene's, which the first pass begins at
  SurfacePipelines find_;
  SurfacePipelines blend_;
  VkExtent2D extent_{};
  std::array<UsedImage, 2> depths_; // of the last layer and the present one, in turns
};

ReverseDepthPeeling::ReverseDepthPeeling(const MethodHost& host, const MethodOptions& options)
    : gpu_(host.gpu),
      complexity_(host, "reverse-depth-peeling"),
      sets_{makeSet(gpu_), makeSet(gpu_)},
      opaqueSet_(makeSet(gpu_)),
      find_(makeFind(host, opaqueSet_.layout())),
      blend_(makeBlend(host, options, opaqueSet_.layout())) {}

void ReverseDepthPeeling::setTarget(const MethodTarget& target) {
  extent_ = target.extent;
  complexity_.setTarget(target);
  GpuImageInfo info;
  info.extent = extent_;
  info.format = kReverseDepthFormat;
  info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  info.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  for (std::size_t i = 0; i < depths_.size(); ++i) {
    depths_[i].ensure(gpu_, info, "layer depth");
    sets_[i].writeImage(0, depths_[i].get().view(), kLayout);
  }
  opaqueSet_.writeImage(0, target.depth, kLayout);
}

void ReverseDepthPeeling::releaseTarget() {
  complexity_.releaseTarget();
  for (UsedImage& depth : depths_) depth = UsedImage();
}

void ReverseDepthPeeling::draw(Frame& frame) {
  complexity_.measure(frame);
  UsedImage* last = &frame.images().depth();
  VkDescriptorSet lastSet = opaqueSet_.set();
  for (std::uint32_t pass = 0; pass < complexity_.deepest(); ++pass) {
    UsedImage& found = depths_[pass % 2];
    find(frame, *last, found, lastSet);
    frame.endPass("find");
    blend(frame, found, lastSet);
    frame.endPass("blend");
    last = &found;
    lastSet = sets_[pass % 2].set();
    if ((pass + 1) % DepthComplexity::kRounds == 0) frame.submitAndWait();
  }
}

void ReverseDepthPeeling::find(Frame& frame, UsedImage& last, UsedImage& found, VkDescriptorSet lastSet) {
  // The pass before it wrote the last layer's depth -> the fragments of this one read it.
  last.cmdUse(frame.commands(), VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, kFragmentSample);
  found.discard();
  Scope scope = frame.images().wholeScope();
  scope.depth = {.image = &found, .depth = AspectUse::Write, .clear = VkClearDepthStencilValue{1.0F, 0}};
  cmdBeginScope(frame.commands(), scope);
  drawSurfaces(frame, find_, lastSet);
  vkCmdEndRendering(frame.commands());
}

void ReverseDepthPeeling::blend(Frame& frame, UsedImage& found, VkDescriptorSet lastSet) {
  Scope scope = frame.images().wholeScope();
  scope.colors.push_back({.image = &frame.images().color()});
  scope.depth = {.image = &found, .depth = AspectUse::Test};
  cmdBeginScope(frame.commands(), scope);
  drawSurfaces(frame, blend_, lastSet);
  vkCmdEndRendering(frame.commands());
}

// The first pass begins at the opaque scene, and a surface in its very plane is seen.
void ReverseDepthPeeling::drawSurfaces(Frame& frame, const SurfacePipelines& pipelines, VkDescriptorSet lastSet) const {
  const std::uint32_t first = lastSet == opaqueSet_.set() ? 1 : 0;
  vkCmdPushConstants(frame.commands(), pipelines.layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(first), &first);
  frame.drawSurfaces(pipelines, lastSet);
}

FrameStats ReverseDepthPeeling::stats() const {
  FrameStats stats = complexity_.stats();
  stats.totalBytes += std::uint64_t{8} * extent_.width * extent_.height;
  return stats;
}

} // namespace

std::unique_ptr<Method> makeReverseDepthPeeling(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<ReverseDepthPeeling>(host, options);
}

} // namespace vitrail::tool
