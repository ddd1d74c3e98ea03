// What the library keeps for one VkDevice: functions, layouts, compute pipelines, limits.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>

#include "dispatch.h"
#include "log.h"
#include "pipelines.h"
#include "vitrail/bindings.h"
#include "vitrail/vitrail.h"

namespace vitrail {

struct Limits {
  std::uint64_t storageBufferRange = 0;
  std::uint64_t allocationSize = 0;
  std::uint64_t heapSize = 0;          // the largest device-local one
  std::uint64_t alignment = 1;         // of every part of a target's buffer
  VkSampleCountFlags sampleCounts = 0; // that colour and depth attachments and sampled images share
  bool isCpu = false;                  // a driver that runs on the CPU
  bool exchangesInGroups = false;      // compute shaders exchange values within at least 8 invocations
  bool fewFragmentCores = false;       // a GPU that runs fragment shaders on a small part of its cores
};

} // namespace vitrail

struct VitrailContext_T {
  vitrail::Dispatch vk;
  vitrail::Log log;
  vitrail::Limits limits;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::uint32_t features = 0; // VitrailFeatureBits
  const VkAllocationCallbacks* allocator = nullptr;
  VkPhysicalDeviceMemoryProperties memory{};
  VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;     // the target's resources
  VkDescriptorSetLayout viewSetLayout = VK_NULL_HANDLE; // the images of one view
  VkPipelineLayout resolveLayout = VK_NULL_HANDLE;      // both of them
  VkPipelineCache cache = VK_NULL_HANDLE;
  std::mutex pipelinesMutex; // guards `pipelines`
  std::map<vitrail::ComputeKey, VkPipeline> pipelines;

  [[nodiscard]] bool has(VitrailFeatureBits feature) const { return (features & feature) != 0; }

  // Names a Vulkan object for debuggers and the validation layer, where the host has enabled debug utils.
  void name(VkObjectType type, std::uint64_t handle, const char* text) const;

  // The object's handle as vkSetDebugUtilsObjectNameEXT takes it.
  template <class Handle>
  void name(VkObjectType type, Handle handle, const char* text) const {
    name(type, reinterpret_cast<std::uint64_t>(handle), text);
  }
};
