#include "fragment_pool.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kFragmentsPerPixel = 4; // the first guess

} // namespace

FragmentPool::FragmentPool(Gpu& gpu, SingleSet& set, FragmentPoolInfo info)
    : gpu_(gpu), set_(set), info_(std::move(info)) {}

void FragmentPool::guess(std::uint64_t pixels, bool surfaces) {
  make(surfaces ? std::min(kFragmentsPerPixel * pixels, most()) : 0);
}

bool FragmentPool::fits(std::uint64_t fragments) {
  if (fragments <= capacity_) return true;
  if (fragments > most()) {
    throw GpuError(
        fmt::format("the method {} holds all {} fragments of the picture at once, and has room for {}: use "
                    "linked-list, or a smaller --size",
                    info_.method, fragments, most()));
  }
  make(fragments);
  return false;
}

// What one shader can reach, and one allocation can hold.
std::uint64_t FragmentPool::most() const {
  const std::uint64_t reach = gpu_.properties().limits.maxStorageBufferRange;
  return std::min(reach, gpu_.maxAllocation()) / info_.fragmentBytes;
}

void FragmentPool::make(std::uint64_t fragments) {
  buffer_ = GpuBuffer();                             // first: the old one and the new one need not fit together
  capacity_ = std::max<std::uint64_t>(fragments, 1); // there are no empty buffers
  buffer_ =
      GpuBuffer(gpu_, bytes(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryKind::Device, info_.method + " fragments");
  set_.writeBuffer(info_.binding, buffer_.get(), buffer_.size());
}

} // namespace vitrail::tool
