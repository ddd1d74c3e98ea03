// Numbers that shaders write and the host reads: a storage buffer and the copy of it that the host maps.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include "barrier.h"
#include "resources.h"

namespace vitrail::tool {

class Counters {
 public:
  Counters() = default;
  // `usage` beside that of storage buffers.
  Counters(Gpu& gpu, std::uint64_t bytes, const std::string& name, VkBufferUsageFlags usage = 0);

  const GpuBuffer& buffer() const { return buffer_; } // storage
  std::uint64_t bytes() const { return buffer_.size() + readback_.size(); }

  // Sets all to 0 after the last cmdRead(), before `user` reads and writes them. Outside a rendering scope.
  void cmdClear(VkCommandBuffer commands, const Access& user) const;
  // Hands them to the host once the commands have been waited for. `writer` wrote them. Outside a rendering scope.
  void cmdRead(VkCommandBuffer commands, const Access& writer) const;

  // What the last cmdRead() that was waited for read.
  template <typename Data>
  Data read() const {
    Data data{};
    std::memcpy(&data, readback_.mapped(), sizeof(data));
    return data;
  }

 private:
  GpuBuffer buffer_;
  GpuBuffer readback_;
};

} // namespace vitrail::tool
