// The memory of methods that hold all fragments of a picture at once, in one buffer that grows to what pictures have.
#pragma once

#include <cstdint>
#include <string>

#include "../../gpu/descriptors.h"
#include "../../gpu/resources.h"

namespace vitrail::tool {

struct FragmentPoolInfo {
  std::string method;              // whose it is
  std::uint64_t fragmentBytes = 0; // of each
  std::uint32_t binding = 0;       // of the set, a storage buffer
};

class FragmentPool {
 public:
  // Points the set's binding at its memory whenever it makes some. Both outlive the pool.
  FragmentPool(Gpu& gpu, SingleSet& set, FragmentPoolInfo info);

  // Makes room for what most pictures of so many pixels have; for no fragment where `surfaces` is false. No frame is
  // pending, for this and fits(). Throws GpuError where the device has no memory for it.
  void guess(std::uint64_t pixels, bool surfaces);
  // Whether it had room for so many fragments. Where it had not it is made so large. Throws GpuError where the device
  // cannot hold them.
  bool fits(std::uint64_t fragments);
  void release() { buffer_ = GpuBuffer(); }

  bool made() const { return buffer_.get() != VK_NULL_HANDLE; }
  std::uint64_t capacity() const { return capacity_; }
  std::uint64_t bytes() const { return capacity_ * info_.fragmentBytes; }

 private:
  std::uint64_t most() const;
  void make(std::uint64_t fragments);

  Gpu& gpu_;
  SingleSet& set_;
  FragmentPoolInfo info_;
  GpuBuffer buffer_;
  std::uint64_t capacity_ = 0;
};

} // namespace vitrail::tool
