// The Vulkan functions that the library calls, loaded through the host's vkGetInstanceProcAddr: the library links no
// loader and keeps no global function pointers.
#pragma once

#include <vulkan/vulkan_core.h>

namespace vitrail {

#define VITRAIL_INSTANCE_FUNCTIONS(X)  \
  X(GetDeviceProcAddr)                 \
  X(GetPhysicalDeviceFeatures2)        \
  X(GetPhysicalDeviceFormatProperties) \
  X(GetPhysicalDeviceMemoryProperties) \
  X(GetPhysicalDeviceProperties2)      \
  X(GetPhysicalDeviceQueueFamilyProperties)

#define VITRAIL_DEVICE_FUNCTIONS(X) \
  X(AllocateDescriptorSets)         \
  X(AllocateMemory)                 \
  X(BindBufferMemory)               \
  X(CmdBindDescriptorSets)          \
  X(CmdBindPipeline)                \
  X(CmdCopyBuffer)                  \
  X(CmdCopyQueryPoolResults)        \
  X(CmdDispatch)                    \
  X(CmdDispatchIndirect)            \
  X(CmdDrawIndirect)                \
  X(CmdFillBuffer)                  \
  X(CmdPipelineBarrier)             \
  X(CmdPushConstants)               \
  X(CmdResetQueryPool)              \
  X(CmdSetScissor)                  \
  X(CmdSetViewport)                 \
  X(CmdUpdateBuffer)                \
  X(CmdWriteTimestamp)              \
  X(CreateBuffer)                   \
  X(CreateComputePipelines)         \
  X(CreateDescriptorPool)           \
  X(CreateDescriptorSetLayout)      \
  X(CreateGraphicsPipelines)        \
  X(CreatePipelineLayout)           \
  X(CreateQueryPool)                \
  X(CreateShaderModule)             \
  X(DestroyBuffer)                  \
  X(DestroyDescriptorPool)          \
  X(DestroyDescriptorSetLayout)     \
  X(DestroyPipeline)                \
  X(DestroyPipelineLayout)          \
  X(DestroyQueryPool)               \
  X(DestroyShaderModule)            \
  X(FreeMemory)                     \
  X(GetBufferDeviceAddress)         \
  X(GetBufferMemoryRequirements)    \
  X(MapMemory)                      \
  X(UpdateDescriptorSets)

struct Functions {
#define VITRAIL_DECLARE(name) PFN_vk##name name = nullptr;
  VITRAIL_INSTANCE_FUNCTIONS(VITRAIL_DECLARE)
  VITRAIL_DEVICE_FUNCTIONS(VITRAIL_DECLARE)
#undef VITRAIL_DECLARE
  PFN_vkSetDebugUtilsObjectNameEXT SetDebugUtilsObjectNameEXT = nullptr; // null where the host has not enabled it

  // Fills the table. Returns the name of a function that is missing, or null where all are there.
  const char* load(VkInstance instance, VkDevice device, PFN_vkGetInstanceProcAddr getInstanceProcAddr);
};

} // namespace vitrail
