#include "dispatch_compute.h"

#include <algorithm>

#include "barrier.h"

namespace vitrail {

namespace {

constexpr std::uint32_t kMostNodeGroups = 32768; // more nodes than that are several a thread

void bindSet(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, std::uint32_t number, VkDescriptorSet set) {
  target.context->vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, target.context->resolveLayout,
                                           number, 1, &set, 0, nullptr);
}

} // namespace

void bindTargetSet(VkCommandBuffer commandBuffer, const VitrailTarget_T& target) {
  bindSet(commandBuffer, target, 0, target.storage.set);
}

void bindViewSet(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, std::uint32_t view) {
  bindSet(commandBuffer, target, 1, target.storage.viewSets[view]);
}

void dispatchOne(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, VkPipeline pipeline) {
  const Dispatch& vk = target.context->vk;
  vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  vk.CmdDispatch(commandBuffer, 1, 1, 1);
}

void dispatchNodes(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, VkPipeline pipeline) {
  const Dispatch& vk = target.context->vk;
  const std::uint32_t groups = target.storage.nodeCapacity / kGroupNodes + 1;
  vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  vk.CmdDispatch(commandBuffer, std::min(groups, kMostNodeGroups), 1, 1);
}

void dispatchIndirect(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, VkPipeline pipeline,
                      std::size_t counter) {
  const Dispatch& vk = target.context->vk;
  const Storage& storage = target.storage;
  vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  vk.CmdDispatchIndirect(commandBuffer, storage.buffer, storage.offset + storage.layout.control.offset + counter);
}

void betweenDispatches(VkCommandBuffer commandBuffer, const VitrailTarget_T& target) {
  // Writer: the dispatch before (the pixels that it leaves, how many, and the picture). Readers: the command processor
  // and the next dispatch. Their pixels and lists are not the same ones, but the image and the counters are.
  recordBarrier(commandBuffer, target, {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT},
                {VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                 VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT});
}

} // namespace vitrail
