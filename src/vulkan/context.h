// What the library keeps for one VkDevice: functions, layouts, pipelines, limits.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>

#include "dispatch.h"
#include "log.h"
#include "vitrail/vitrail.h"

namespace vitrail {

// The bindings of the target's descriptor set, as shaders/vitrail/collect.glsl and src/shaders name them.
enum Binding : std::uint32_t {
  kParametersBinding,
  kControlBinding,
  kHeadsBinding,
  kNodesBinding,
  kLongListsBinding,
  kBindingCount
};

// The colour formats that the resolve writes, each with a pipeline of its own.
inline constexpr std::array<VkFormat, 2> kColorFormats = {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT};

// The compute resolve: short lists, then, by indirect dispatch, the long ones.
struct ResolvePipelines {
  VkPipeline shortLists = VK_NULL_HANDLE;
  VkPipeline longLists = VK_NULL_HANDLE;
};

// The index of a format in kColorFormats, or its size where it is not there.
std::size_t colorFormatIndex(VkFormat format);

struct Limits {
  std::uint64_t storageBufferRange = 0;
  std::uint64_t allocationSize = 0;
  std::uint64_t storageBufferAlignment = 1;
};

} // namespace vitrail

struct VitrailContext_T {
  vitrail::Dispatch vk;
  vitrail::Log log;
  vitrail::Limits limits;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  const VkAllocationCallbacks* allocator = nullptr;
  VkPhysicalDeviceMemoryProperties memory{};
  VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;      // the target's resources
  VkDescriptorSetLayout colorSetLayout = VK_NULL_HANDLE; // one colour image
  VkPipelineLayout resolveLayout = VK_NULL_HANDLE;
  VkPipelineCache cache = VK_NULL_HANDLE;
  std::mutex pipelines; // guards `resolve`
  // By colour format; made for the first target that has it.
  std::array<vitrail::ResolvePipelines, vitrail::kColorFormats.size()> resolve{};

  // The resolve pipelines of kColorFormats[format].
  VkResult resolvePipelines(std::size_t format, vitrail::ResolvePipelines* made);

  // Names a Vulkan object for debuggers and the validation layer, where the host has enabled debug utils.
  void name(VkObjectType type, std::uint64_t handle, const char* text) const;

  // The object's handle as vkSetDebugUtilsObjectNameEXT takes it.
  template <class Handle>
  void name(VkObjectType type, Handle handle, const char* text) const {
    name(type, reinterpret_cast<std::uint64_t>(handle), text);
  }
};
