// What the library keeps for one VkDevice: functions, layouts, compute pipelines, limits.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>

#include "core/device_limits.h"
#include "core/log.h"
#include "functions.h"
#include "pipelines.h"
#include "vitrail/vulkan.h"

struct VitrailVkContext_T {
  vitrail::Functions vk;
  vitrail::Log log;
  vitrail::DeviceLimits limits;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::uint32_t features = 0; // VitrailVkFeatureBits
  const VkAllocationCallbacks* allocator = nullptr;
  VkPhysicalDeviceMemoryProperties memory{};
  VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;     // the target's resources
  VkDescriptorSetLayout viewSetLayout = VK_NULL_HANDLE; // the images of one view
  VkPipelineLayout resolveLayout = VK_NULL_HANDLE;      // both of them
  VkPipelineCache cache = VK_NULL_HANDLE;
  std::mutex pipelinesMutex; // guards `pipelines`
  std::map<vitrail::ComputeKey, VkPipeline> pipelines;
  // The handle and its targets: what the context has is freed with the last of them.
  std::atomic<std::uint32_t> owners{1};
  std::atomic<bool> destroyed{false}; // the handle is gone

  [[nodiscard]] bool has(VitrailVkFeatureBits feature) const { return (features & feature) != 0; }

  // Names a Vulkan object for debuggers and the validation layer, where the host has enabled debug utils.
  void name(VkObjectType type, std::uint64_t handle, const char* text) const;

  // The object's handle as vkSetDebugUtilsObjectNameEXT takes it.
  template <class Handle>
  void name(VkObjectType type, Handle handle, const char* text) const {
    name(type, reinterpret_cast<std::uint64_t>(handle), text);
  }
};

namespace vitrail {

// One owner less.
void releaseContext(VitrailVkContext context);

} // namespace vitrail
