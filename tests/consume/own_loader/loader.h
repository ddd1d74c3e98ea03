/* Vulkan's functions as pointers of the same names, in a program that links no loader. */
#ifndef LOADER_H
#define LOADER_H

#include <vulkan/vulkan.h>

/* FUNCTION(name) for every function that the program calls. */
#define EACH_FUNCTION(FUNCTION)                      \
  FUNCTION(vkAllocateCommandBuffers)                 \
  FUNCTION(vkAllocateMemory)                         \
  FUNCTION(vkBeginCommandBuffer)                     \
  FUNCTION(vkBindBufferMemory)                       \
  FUNCTION(vkBindImageMemory)                        \
  FUNCTION(vkCmdBeginRendering)                      \
  FUNCTION(vkCmdBindDescriptorSets)                  \
  FUNCTION(vkCmdBindPipeline)                        \
  FUNCTION(vkCmdCopyImageToBuffer)                   \
  FUNCTION(vkCmdDraw)                                \
  FUNCTION(vkCmdEndRendering)                        \
  FUNCTION(vkCmdPipelineBarrier)                     \
  FUNCTION(vkCmdPushConstants)                       \
  FUNCTION(vkCreateBuffer)                           \
  FUNCTION(vkCreateCommandPool)                      \
  FUNCTION(vkCreateDevice)                           \
  FUNCTION(vkCreateFence)                            \
  FUNCTION(vkCreateGraphicsPipelines)                \
  FUNCTION(vkCreateImage)                            \
  FUNCTION(vkCreateImageView)                        \
  FUNCTION(vkCreatePipelineLayout)                   \
  FUNCTION(vkCreateShaderModule)                     \
  FUNCTION(vkDestroyBuffer)                          \
  FUNCTION(vkDestroyCommandPool)                     \
  FUNCTION(vkDestroyDevice)                          \
  FUNCTION(vkDestroyFence)                           \
  FUNCTION(vkDestroyImage)                           \
  FUNCTION(vkDestroyImageView)                       \
  FUNCTION(vkDestroyInstance)                        \
  FUNCTION(vkDestroyPipeline)                        \
  FUNCTION(vkDestroyPipelineLayout)                  \
  FUNCTION(vkDestroyShaderModule)                    \
  FUNCTION(vkEndCommandBuffer)                       \
  FUNCTION(vkEnumeratePhysicalDevices)               \
  FUNCTION(vkFreeCommandBuffers)                     \
  FUNCTION(vkFreeMemory)                             \
  FUNCTION(vkGetBufferMemoryRequirements)            \
  FUNCTION(vkGetDeviceQueue)                         \
  FUNCTION(vkGetImageMemoryRequirements)             \
  FUNCTION(vkGetPhysicalDeviceFeatures)              \
  FUNCTION(vkGetPhysicalDeviceFormatProperties)      \
  FUNCTION(vkGetPhysicalDeviceMemoryProperties)      \
  FUNCTION(vkGetPhysicalDeviceProperties)            \
  FUNCTION(vkGetPhysicalDeviceQueueFamilyProperties) \
  FUNCTION(vkMapMemory)                              \
  FUNCTION(vkQueueSubmit)                            \
  FUNCTION(vkWaitForFences)

#define DECLARE(name) extern PFN_##name name;
EACH_FUNCTION(DECLARE)
#undef DECLARE

/* Opens the system's Vulkan loader; null if there is none, or if something has linked it already. */
PFN_vkGetInstanceProcAddr openLoader(void);

/* Fills in the pointers above. */
void loadFunctions(VkInstance instance, PFN_vkGetInstanceProcAddr getInstanceProcAddr);

#endif
