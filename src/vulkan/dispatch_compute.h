// The forms of compute dispatch that the recording calls use.
#pragma once

#include <cstddef>

#include "target.h"

namespace vitrail {

// Binds the target's set, and the images of a view where the kernels that follow need them.
void bindTargetSet(VkCommandBuffer commandBuffer, const VitrailTarget_T& target);
void bindViewSet(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, std::uint32_t view);

// One invocation.
void dispatchOne(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, VkPipeline pipeline);

// One thread a node of the pool, or several nodes, of those that are in use.
void dispatchNodes(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, VkPipeline pipeline);

// As many work groups as the counters say: `counter` is the offset of three words in VitrailControl.
void dispatchIndirect(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, VkPipeline pipeline,
                      std::size_t counter);

// The arguments of a class of lists.
constexpr std::size_t classGroups(std::size_t number) {
  return offsetof(layout::VitrailControl, classes) + number * sizeof(layout::VitrailListClass) +
         offsetof(layout::VitrailListClass, groupsX);
}

// The barrier before an indirect dispatch over what a dispatch left to it.
void betweenDispatches(VkCommandBuffer commandBuffer, const VitrailTarget_T& target);

} // namespace vitrail
