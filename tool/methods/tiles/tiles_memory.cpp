#include "tiles_memory.h"

#include <algorithm>

namespace vitrail::tool {

namespace {

// Of set 3, whose other bindings are images and what all frames have.
constexpr std::array<std::uint32_t, 14> kBindings{2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14, 15, 16, 19};

// Bytes of each, in all buffers together.
constexpr std::uint64_t kRecordBytes = 32 + 12 + 8; // and the masks of several samples
constexpr std::uint64_t kFragmentBytes = 2 * 8;
constexpr std::uint64_t kDeepBytes = 16 + 64 * 16; // and the states of their pixels

std::uint64_t withSpare(std::uint64_t wanted) { return wanted + wanted / 8; }

} // namespace

TilesMemory::TilesMemory(Gpu& gpu, SingleSet& set, std::uint32_t samples) : gpu_(gpu), set_(set), samples_(samples) {}

void TilesMemory::make(std::uint32_t binding, std::uint64_t bytes, const char* name) {
  const auto place = static_cast<std::size_t>(std::ranges::find(kBindings, binding) - kBindings.begin());
  GpuBuffer& buffer = buffers_.at(place);
  buffer = GpuBuffer(); // first: the old one and the new one need not fit together
  buffer = GpuBuffer(gpu_, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                     MemoryKind::Device, name);
  set_.writeBuffer(binding, buffer.get(), buffer.size());
}

void TilesMemory::setTiles(std::uint32_t tiles, std::uint64_t budget) {
  tiles_ = tiles;
  budget_ = budget;
  make(2, std::uint64_t{tiles} * 8, "tiles records of tiles");
  make(7, std::uint64_t{tiles} * 4 * shaders::TILES_CLASSES, "tiles lists");
}

double TilesMemory::excess(const TilesNeeds& needs) const {
  const auto reach = static_cast<double>(
      std::min<std::uint64_t>(gpu_.properties().limits.maxStorageBufferRange, gpu_.maxAllocation()));
  double most = 0.0;
  double all = static_cast<double>(tiles_) * (8.0 + 4.0 * shaders::TILES_CLASSES);
  const auto add = [&](std::uint64_t count, std::uint64_t largest, std::uint64_t together) {
    // Numbers have 32 bits, and what is done in strides must not pass their end.
    most = std::max({most, static_cast<double>(count * largest) / reach, static_cast<double>(count) / 2e9});
    all += static_cast<double>(count * together);
  };
  add(needs.records, std::max<std::uint64_t>(32, maskBytes()), kRecordBytes + maskBytes());
  add(needs.large, 8, 8);
  add(needs.deep, stateBytes(), kDeepBytes + stateBytes());
  add(needs.blocks, 8, 8);
  add(needs.fragments, 8, kFragmentBytes);
  add(needs.chunks, 8, 8);
  return std::max(most, all / static_cast<double>(budget_));
}

double TilesMemory::grow(const TilesNeeds& needs) {
  // With some to spare; without; and without what earlier pictures needed more of.
  enum class Room { Spare, Enough, Least };
  TilesNeeds next;
  for (const Room room : {Room::Spare, Room::Enough, Room::Least}) {
    const auto sized = [room](std::uint64_t wanted, std::uint64_t had) {
      wanted = std::max<std::uint64_t>(wanted, 1);
      if (room == Room::Least) return wanted;
      return wanted > had ? room == Room::Spare ? withSpare(wanted) : wanted : had;
    };
    next = {.records = sized(needs.records, capacity_.records),
            .large = sized(needs.large, capacity_.large),
            .deep = sized(needs.deep, capacity_.deep),
            .blocks = sized(needs.blocks, capacity_.blocks),
            .fragments = sized(needs.fragments, capacity_.fragments),
            .chunks = sized(needs.chunks, capacity_.chunks)};
    const double over = excess(next);
    if (over <= 1.0) break;
    if (room == Room::Least) return over;
  }
  resize(next);
  return 0.0;
}

void TilesMemory::resize(const TilesNeeds& next) {
  if (next.records != capacity_.records) {
    make(3, next.records * 32, "tiles records");
    make(4, next.records * 12, "tiles places");
    make(5, next.records * 8, "tiles pairs");
    make(19, next.records * maskBytes(), "tiles samples");
  }
  if (next.large != capacity_.large) make(6, next.large * 8, "tiles large triangles");
  if (next.deep != capacity_.deep) {
    make(8, next.deep * 16, "tiles deep tiles");
    make(11, next.deep * 64 * 16, "tiles deep pixels");
    make(16, next.deep * stateBytes(), "tiles states of pixels");
  }
  if (next.blocks != capacity_.blocks) make(12, next.blocks * 8, "tiles blocks of records");
  if (next.fragments != capacity_.fragments) {
    make(13, next.fragments * 8, "tiles fragments");
    make(14, next.fragments * 8, "tiles sorted fragments");
  }
  if (next.chunks != capacity_.chunks) make(15, next.chunks * 8, "tiles chunks of fragments");
  capacity_ = next;
}

void TilesMemory::release() {
  for (GpuBuffer& buffer : buffers_) buffer = GpuBuffer();
  capacity_ = {};
  tiles_ = 0;
}

std::uint64_t TilesMemory::bytes() const {
  std::uint64_t sum = 0;
  for (const GpuBuffer& buffer : buffers_) sum += buffer.get() != VK_NULL_HANDLE ? buffer.size() : 0;
  return sum;
}

} // namespace vitrail::tool
