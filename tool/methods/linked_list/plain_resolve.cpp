#include "plain_resolve.h"

#include <span>

#include "../../gpu/pixel_pass_shared.h"
#include "shaders/plain_resolve.comp.h"
#include "shaders/plain_resolve_address.comp.h"
#include "shaders/plain_resolve_depths.comp.h"
#include "shaders/plain_resolve_depths_address.comp.h"
#include "shaders/plain_resolve_samples.comp.h"
#include "shaders/plain_resolve_samples_address.comp.h"

namespace vitrail::tool {

namespace {

struct PlainConstants { // push constants
  std::uint32_t peeled;
  std::uint32_t showsLess;
};

std::span<const std::uint32_t> resolveCode(bool several, bool testsDepth, bool byAddress) {
  if (testsDepth && byAddress) return shaders::plain_resolve_depths_address_comp;
  if (testsDepth) return shaders::plain_resolve_depths_comp;
  if (several && byAddress) return shaders::plain_resolve_samples_address_comp;
  if (several) return shaders::plain_resolve_samples_comp;
  if (byAddress) return shaders::plain_resolve_address_comp;
  return shaders::plain_resolve_comp;
}

} // namespace

PlainResolve::PlainResolve(Gpu& gpu, VkDescriptorSetLayout lists, std::uint32_t samples, bool sorted)
    : samples_(samples),
      testsDepth_(samples > 1 && !gpu.features().postDepthCoverage),
      set_(gpu,
           {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
            {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
            {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}},
           "plain resolve"),
      layout_(makePipelineLayout(gpu, {lists, set_.layout()}, {VK_SHADER_STAGE_COMPUTE_BIT, sizeof(PlainConstants)},
                                 "plain resolve")),
      pipeline_(makeComputePipeline(gpu, layout_.get(),
                                    resolveCode(samples > 1, testsDepth_, gpu.features().poolByAddress),
                                    "plain resolve", {{0, samples}, {1, sorted ? VK_TRUE : VK_FALSE}})) {}

void PlainResolve::setTarget(const MethodTarget& target) {
  set_.writeImage(0, target.color, VK_IMAGE_LAYOUT_GENERAL);
  if (samples_ > 1) set_.writeImage(1, target.opaque, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  if (testsDepth_) set_.writeImage(2, target.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
}

void PlainResolve::cmdResolve(VkCommandBuffer commands, VkDescriptorSet lists, VkExtent2D area, std::uint32_t peeled,
                              bool showsLess) const {
  const std::array<VkDescriptorSet, 2> sets{lists, set_.set()};
  const PlainConstants constants{peeled, showsLess ? 1U : 0U};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0,
                          static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
  vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants), &constants);
  vkCmdDispatch(commands, shaders::pixelGroups(area.width), shaders::pixelGroups(area.height), 1);
}

} // namespace vitrail::tool
