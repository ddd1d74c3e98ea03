// Records the passes of a frame plan.
#pragma once

#include "target.h"

namespace vitrail {

// What a call's passes need beyond the target.
struct CallInfo {
  std::uint32_t view = 0; // of a resolve
  VitrailRect copied{};   // of a copy of lists
  VkBuffer copyBuffer = VK_NULL_HANDLE;
  VkDeviceSize copyOffset = 0;
};

// The passes of a call, with the barriers between them.
void recordCall(VkCommandBuffer commandBuffer, VitrailVkTarget_T& target, Call call, const CallInfo& info = {});

// The barriers that a call needs before its passes.
void recordBoundary(VkCommandBuffer commandBuffer, const VitrailVkTarget_T& target, Call call);

// The same as data.
void boundaryOf(const VitrailVkTarget_T& target, Call call, VitrailVkBarriers& barriers);

} // namespace vitrail
