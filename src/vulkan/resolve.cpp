// The recording call that sorts and blends, and leaves the frame's counters for the host to read.
#include <array>
#include <cstddef>

#include "barrier.h"

namespace vitrail {

namespace {

constexpr std::uint32_t kGroupSide = 8; // the local size of src/shaders/resolve.comp, in both directions

void dispatchResolve(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, std::uint32_t colorView) {
  const VitrailContext_T& context = *target.context;
  const std::array<VkDescriptorSet, 2> sets = {target.set, target.colorSets[colorView]};
  context.vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, context.resolveLayout, 0,
                                   static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
  context.vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, target.resolve.shortLists);
  context.vk.CmdDispatch(commandBuffer, (target.extent.width + kGroupSide - 1) / kGroupSide,
                         (target.extent.height + kGroupSide - 1) / kGroupSide, 1);

  // Writer: the first dispatch (the pixels that it leaves, how many, and the picture). Readers: the command processor
  // and the second dispatch. The pixels and lists of the two are not the same ones, but the image and the counters are.
  VkMemoryBarrier betweenDispatches{};
  betweenDispatches.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  betweenDispatches.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
  betweenDispatches.dstAccessMask =
      VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
  context.vk.CmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1,
                                &betweenDispatches, 0, nullptr, 0, nullptr);
  context.vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, target.resolve.longLists);
  context.vk.CmdDispatchIndirect(commandBuffer, target.control.buffer, offsetof(layout::VitrailControl, groupsX));
}

// Copies the counters to the frame's slot, then the tag that says that they are there.
void copyStats(VkCommandBuffer commandBuffer, const VitrailTarget_T& target) {
  const Dispatch& vk = target.context->vk;
  // Writers: the resolve (counters) and the clear (the slot's tag). Reader and writer: the copy.
  const VkDeviceSize slot = target.slotOffset(target.frame);
  const std::array<VkBufferMemoryBarrier, 2> beforeCopy = {
      bufferBarrier(target.control, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_TRANSFER_READ_BIT),
      bufferBarrier(target.stats.buffer, slot, sizeof(StatsSlot), VK_ACCESS_TRANSFER_WRITE_BIT,
                    VK_ACCESS_TRANSFER_WRITE_BIT)};
  recordBarriers(commandBuffer, target, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                 VK_PIPELINE_STAGE_TRANSFER_BIT, beforeCopy);

  const VkBufferCopy region{0, slot, sizeof(layout::VitrailControl)};
  vk.CmdCopyBuffer(commandBuffer, target.control.buffer, target.stats.buffer, 1, &region);

  // Writer: the copy. Readers: the host, and the order of the tag, which is written after.
  const std::array<VkBufferMemoryBarrier, 1> beforeTag = {
      bufferBarrier(target.stats.buffer, slot, sizeof(StatsSlot), VK_ACCESS_TRANSFER_WRITE_BIT,
                    VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT)};
  recordBarriers(commandBuffer, target, VK_PIPELINE_STAGE_TRANSFER_BIT,
                 VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_HOST_BIT, beforeTag);
  const std::uint64_t tag = target.frame + 1;
  vk.CmdUpdateBuffer(commandBuffer, target.stats.buffer, slot + offsetof(StatsSlot, tag), sizeof(tag), &tag);

  // Writer: the tag. Reader: the host.
  const std::array<VkBufferMemoryBarrier, 1> beforeHost = {bufferBarrier(
      target.stats.buffer, slot, sizeof(StatsSlot), VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_HOST_READ_BIT)};
  recordBarriers(commandBuffer, target, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, beforeHost);
}

} // namespace

} // namespace vitrail

extern "C" void vitrailCmdResolve(VkCommandBuffer commandBuffer, VitrailTarget target, const VitrailResolveInfo* info) {
  vitrail::dispatchResolve(commandBuffer, *target, info != nullptr ? info->colorView : 0);
  vitrail::copyStats(commandBuffer, *target);
}
