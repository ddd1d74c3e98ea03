// Shorthand for the buffer barriers of the recording calls.
#pragma once

#include <span>

#include "target.h"

namespace vitrail {

// Orders accesses to one whole buffer of a target.
inline VkBufferMemoryBarrier bufferBarrier(VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size,
                                           VkAccessFlags source, VkAccessFlags destination) {
  VkBufferMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER;
  barrier.srcAccessMask = source;
  barrier.dstAccessMask = destination;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.buffer = buffer;
  barrier.offset = offset;
  barrier.size = size;
  return barrier;
}

inline VkBufferMemoryBarrier bufferBarrier(const Buffer& buffer, VkAccessFlags source, VkAccessFlags destination) {
  return bufferBarrier(buffer.buffer, 0, VK_WHOLE_SIZE, source, destination);
}

inline void recordBarriers(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, VkPipelineStageFlags source,
                           VkPipelineStageFlags destination, std::span<const VkBufferMemoryBarrier> barriers) {
  target.context->vk.CmdPipelineBarrier(commandBuffer, source, destination, 0, 0, nullptr,
                                        static_cast<std::uint32_t>(barriers.size()), barriers.data(), 0, nullptr);
}

} // namespace vitrail
