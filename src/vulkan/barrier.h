// The barriers of the recording calls.
#pragma once

#include "target.h"

namespace vitrail {

// Records what vitrailBarriers() says of a point.
void recordBarriers(VkCommandBuffer commandBuffer, VitrailTarget target, VitrailBarrierPoint point);

// A barrier on a part of a buffer, which stays with its queue family.
VkBufferMemoryBarrier bufferBarrier(VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, VkAccessFlags source,
                                    VkAccessFlags destination);

// A barrier on all memory between two steps of the library's own.
struct Step {
  VkPipelineStageFlags stages;
  VkAccessFlags accesses;
};
void recordBarrier(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, Step before, Step after);

} // namespace vitrail
