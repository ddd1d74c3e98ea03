#include "barrier.h"

#include "vk.h"

namespace vitrail::tool {

void cmdMemoryBarrier(VkCommandBuffer commands, const Access& before, const Access& after) {
  auto barrier = vkStruct<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
  barrier.srcStageMask = before.stages;
  barrier.srcAccessMask = before.accesses;
  barrier.dstStageMask = after.stages;
  barrier.dstAccessMask = after.accesses;
  auto dependency = vkStruct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

void cmdImageBarrier(VkCommandBuffer commands, VkImage image, const VkImageSubresourceRange& range,
                     VkImageLayout oldLayout, const Access& before, VkImageLayout newLayout, const Access& after) {
  auto barrier = vkStruct<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
  barrier.srcStageMask = before.stages;
  barrier.srcAccessMask = before.accesses;
  barrier.dstStageMask = after.stages;
  barrier.dstAccessMask = after.accesses;
  barrier.oldLayout = oldLayout;
  barrier.newLayout = newLayout;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = range;
  auto dependency = vkStruct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
  dependency.imageMemoryBarrierCount = 1;
  dependency.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

} // namespace vitrail::tool
