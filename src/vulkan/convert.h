// Between the core's words and Vulkan's.
#pragma once

#include <vulkan/vulkan_core.h>

#include "core/frame_plan.h"
#include "core/target_rules.h"
#include "vitrail/vulkan.h"

namespace vitrail {

VkResult toVk(VitrailResult result);
VkPipelineStageFlags toVkStages(std::uint32_t stages);
VkAccessFlags toVkAccess(std::uint32_t accesses);

inline VkRect2D toVk(const VitrailRect& r) {
  return {{static_cast<std::int32_t>(r.x), static_cast<std::int32_t>(r.y)}, {r.width, r.height}};
}

} // namespace vitrail
