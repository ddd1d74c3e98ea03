#include "reverse_depth_peeling.h"

#include "../../gpu/accesses.h"
#include "../../stage/surface_shared.h"
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
          {.set = set, .name = "reverse-depth-peeling find"},
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
  return makeBlendedSurfaces(host, options, {.set = set, .name = "reverse-depth-peeling"}, adjust);
}

} // namespace

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
  frame.drawSurfaces(find_, lastSet);
  vkCmdEndRendering(frame.commands());
}

void ReverseDepthPeeling::blend(Frame& frame, UsedImage& found, VkDescriptorSet lastSet) {
  Scope scope = frame.images().wholeScope();
  scope.colors.push_back({.image = &frame.images().color()});
  scope.depth = {.image = &found, .depth = AspectUse::Test};
  cmdBeginScope(frame.commands(), scope);
  frame.drawSurfaces(blend_, lastSet);
  vkCmdEndRendering(frame.commands());
}

MethodStats ReverseDepthPeeling::stats() const {
  MethodStats stats = complexity_.stats();
  stats.totalBytes += std::uint64_t{8} * extent_.width * extent_.height;
  return stats;
}

} // namespace vitrail::tool
