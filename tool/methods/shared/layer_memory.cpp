#include "layer_memory.h"

#include <algorithm>

#include <fmt/format.h>

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kWordBytes = 4;
constexpr double kMebibyte = 1024.0 * 1024.0;

} // namespace

GpuBuffer makeLayerMemory(Gpu& gpu, VkExtent2D extent, const LayerMemoryInfo& info) {
  const std::uint64_t pixels = std::uint64_t{extent.width} * extent.height;
  const std::uint64_t pixelBytes = kWordBytes * info.words;
  const std::uint64_t most =
      std::min<std::uint64_t>(gpu.properties().limits.maxStorageBufferRange, gpu.maxAllocation());
  if (pixelBytes > most / pixels) { // their product may have more than 64 bits
    const double bytes = static_cast<double>(pixelBytes) * static_cast<double>(pixels);
    throw GpuError(
        fmt::format("the method {} keeps {} layers of {}x{} pixels in {:.0f} MiB, and {} reaches {:.0f}: use "
                    "fewer --layers, a smaller --size, or linked-list",
                    info.method, info.layers, extent.width, extent.height, bytes / kMebibyte,
                    gpu.properties().deviceName, static_cast<double>(most) / kMebibyte));
  }
  return {gpu, pixelBytes * pixels, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
          MemoryKind::Device, info.method + " layers"};
}

} // namespace vitrail::tool
