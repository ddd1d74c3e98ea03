// The memory behind a target: one buffer with everything that shaders share, and the descriptor sets that name its
// parts and the host's images. A target whose pool or extent changes gets another one.
#pragma once

#include <array>
#include <cstdint>

#include "buffer.h"
#include "core/pool.h"
#include "vitrail/vitrail.h"

namespace vitrail {

struct StorageInfo {
  std::uint32_t areaPixels = 0;
  std::uint32_t nodeCapacity = 0;
  VitrailNodeFormat format = VITRAIL_NODE_STANDARD;
  bool keepSums = false;
  VkBuffer buffer = VK_NULL_HANDLE; // the host's own; null: makes one
  VkDeviceSize bufferOffset = 0;
  VitrailViews views{}; // read during create() only
  const char* debugName = nullptr;
};

// Usage of the buffer.
VkBufferUsageFlags storageUsage(const VitrailContext_T& context);

struct Storage {
  std::uint32_t areaPixels = 0;
  std::uint32_t nodeCapacity = 0;
  StorageLayout layout; // of `buffer`, from `offset` on
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;
  VkDeviceAddress nodesAddress = 0; // 0 where the pool is reached through its binding
  Buffer own;                       // empty where the host brought its own
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  std::uint32_t viewCount = 0;
  std::array<VkDescriptorSet, VITRAIL_MAX_COLOR_VIEWS> viewSets{};
  bool sumsAreClear = false; // once all that was recorded has run; a new buffer holds anything

  // Logs its errors. On error the storage is to be destroyed.
  VkResult create(const VitrailContext_T& context, const StorageInfo& info);
  void destroy(const VitrailContext_T& context);
};

} // namespace vitrail
