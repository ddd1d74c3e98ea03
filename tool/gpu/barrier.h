// One memory or image barrier. The caller's comment names the writer and the reader.
#pragma once

#include <volk.h>

#include "resources.h"

namespace vitrail::tool {

// What happens on one side of a barrier.
struct Access {
  VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
  VkAccessFlags2 accesses = VK_ACCESS_2_NONE;
};

void cmdMemoryBarrier(VkCommandBuffer commands, const Access& before, const Access& after);

// Moves `range` of an image from one layout to another.
void cmdImageBarrier(VkCommandBuffer commands, VkImage image, const VkImageSubresourceRange& range,
                     VkImageLayout oldLayout, const Access& before, VkImageLayout newLayout, const Access& after);

} // namespace vitrail::tool
