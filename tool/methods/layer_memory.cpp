#include "layer_memory.h"

#include <algorithm>

#include <fmt/format.h>

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kWordBytes = 4;
constexpr double kMebibyte = 1024.0 * 1024.0;

} // namespace

GpuBuffer makeLayerMemory(Gpu& gpu, VkExtent2D extent, const LayerMemoryInfo& info) {
  const std::uint64_t bytes = kWordBytes * info.words * extent.width * extent.height;
  const std::uint64_t most =
      std::min<std::uint64_t>(gpu.properties().limits.maxStorageBufferRange, gpu.maxAllocation());
  if (bytes > most) {
    throw GpuError(
        fmt::format("the method {} keeps {} layers of {}x{} pixels in {:.0f} MiB, and {} reaches {:.0f}: use "
                    "fewer --layers, a smaller --size, or linked-list",
                    info.method, info.layers, extent.width, extent.height, static_cast<double>(bytes) / kMebibyte,
                    gpu.properties().deviceName, static_cast<double>(most) / kMebibyte));
  }
  return {gpu, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Device,
          info.method + " layers"};
}

} // namespace vitrail::tool
