// The memory behind a target: one buffer with everything that shaders share, and the descriptor sets that name its
// parts and the host's images. A target whose pool or extent changes gets another one.
#pragma once

#include <array>
#include <cstdint>

#include "buffer.h"
#include "core/frame_numbers.h"
#include "core/parameters.h"
#include "core/pool.h"
#include "vitrail/vulkan.h"

namespace vitrail {

struct StorageInfo {
  StorageNeeds needs;
  VkBuffer buffer = VK_NULL_HANDLE; // the host's own; null: makes one
  VkDeviceSize bufferOffset = 0;
  VitrailVkViews views{}; // read during create() only
  const char* debugName = nullptr;
};

// Usage of the buffer.
VkBufferUsageFlags storageUsage(const VitrailVkContext_T& context);

struct Storage {
  StorageNeeds needs;
  StorageLayout layout; // of `buffer`, from `offset` on
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;
  PoolAccess pool;
  Buffer own; // empty where the host brought its own
  VkDescriptorPool descriptors = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  std::uint32_t viewCount = 0;
  std::array<VkDescriptorSet, VITRAIL_MAX_VIEWS> viewSets{};
  FrameUse use;

  // Logs its errors. On error the storage is to be destroyed.
  VkResult create(const VitrailVkContext_T& context, const StorageInfo& info);
  void destroy(const VitrailVkContext_T& context);
};

} // namespace vitrail
