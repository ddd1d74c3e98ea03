#include "tiles_memory.h"

#include <algorithm>

namespace vitrail::tool {

namespace {

// Of set 3, whose other bindings are images and what all frames have.
constexpr std::array<std::uint32_t, 13> kBindings{2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14, 15, 16};

std::uint64_t withSpare(std::uint64_t wanted) { return wanted + wanted / 8; }

} // namespace

void TilesMemory::make(std::uint32_t binding, std::uint64_t bytes, const char* name) {
  const auto place = static_cast<std::size_t>(std::ranges::find(kBindings, binding) - kBindings.begin());
  GpuBuffer& buffer = buffers_.at(place);
  buffer = GpuBuffer(); // first: the old one and the new one need not fit together
  buffer = GpuBuffer(gpu_, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                     MemoryKind::Device, name);
  set_.writeBuffer(binding, buffer.get(), buffer.size());
}

void TilesMemory::setTiles(std::uint32_t tiles) {
  make(2, std::uint64_t{tiles} * 8, "tiles records of tiles");
  make(7, std::uint64_t{tiles} * 4, "tiles lists");
}

bool TilesMemory::grow(const TilesNeeds& needs) {
  const std::uint64_t reach = std::min<std::uint64_t>(gpu_.properties().limits.maxStorageBufferRange,
                                                      gpu_.maxAllocation());
  bool fits = true;
  // Whether there is room for `wanted` of `bytes` each now, and whether it had to be made.
  const auto grown = [&](std::uint64_t wanted, std::uint64_t& capacity, std::uint64_t bytes) {
    if (wanted <= capacity) return false;
    const std::uint64_t most = std::min<std::uint64_t>(reach / bytes, UINT32_MAX);
    if (wanted > most) {
      fits = false;
      return false;
    }
    capacity = std::min(withSpare(wanted), most);
    return true;
  };
  if (grown(needs.records, capacity_.records, 32)) {
    make(3, capacity_.records * 32, "tiles records");
    make(4, capacity_.records * 12, "tiles places");
    make(5, capacity_.records * 8, "tiles pairs");
  }
  if (grown(needs.large, capacity_.large, 8)) make(6, capacity_.large * 8, "tiles large triangles");
  if (grown(needs.deep, capacity_.deep, 64 * 32)) {
    make(8, capacity_.deep * 16, "tiles deep tiles");
    make(11, capacity_.deep * 64 * 16, "tiles deep pixels");
    make(16, capacity_.deep * 64 * 32, "tiles states of pixels");
  }
  if (grown(needs.blocks, capacity_.blocks, 8)) make(12, capacity_.blocks * 8, "tiles blocks of records");
  if (grown(needs.fragments, capacity_.fragments, 8)) {
    make(13, capacity_.fragments * 8, "tiles fragments");
    make(14, capacity_.fragments * 8, "tiles sorted fragments");
  }
  if (grown(needs.chunks, capacity_.chunks, 8)) make(15, capacity_.chunks * 8, "tiles chunks of fragments");
  return fits;
}

void TilesMemory::release() {
  for (GpuBuffer& buffer : buffers_) buffer = GpuBuffer();
  capacity_ = {};
}

std::uint64_t TilesMemory::bytes() const {
  std::uint64_t sum = 0;
  for (const GpuBuffer& buffer : buffers_) sum += buffer.get() != VK_NULL_HANDLE ? buffer.size() : 0;
  return sum;
}

} // namespace vitrail::tool
