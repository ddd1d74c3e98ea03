// The memory of the method tiles: what its passes hand each other, as large as the last pictures needed.
#pragma once

#include <array>
#include <cstdint>

#include "../../gpu/descriptors.h"
#include "../../gpu/resources.h"
#include "tiles_shared.h"

namespace vitrail::tool {

// What a frame needs of what grows.
struct TilesNeeds {
  std::uint64_t records = 0; // triangles in tiles
  std::uint64_t large = 0;   // triangles that are set up in a pass of their own
  std::uint64_t deep = 0;    // tiles whose fragments are collected
  std::uint64_t blocks = 0;  // of their records
  std::uint64_t fragments = 0;
  std::uint64_t chunks = 0; // of their fragments
};

class TilesMemory {
 public:
  // Points the set's bindings from kFirst on at its buffers. Both outlive it.
  TilesMemory(Gpu& gpu, SingleSet& set) : gpu_(gpu), set_(set) {}

  // Makes room for a band of so many tiles. No frame is pending, for this and the next ones. Throws GpuError.
  void setTiles(std::uint32_t tiles);
  // Makes room for what is needed and not there, with some to spare. False: one of them is more than a shader reaches.
  // Throws GpuError where the device has no memory for it.
  bool grow(const TilesNeeds& needs);
  void release();

  const TilesNeeds& capacity() const { return capacity_; }
  const GpuBuffer& tileRecords() const { return buffers_[0]; }
  const GpuBuffer& deepPixels() const { return buffers_[7]; }
  std::uint64_t bytes() const;

 private:
  void make(std::uint32_t binding, std::uint64_t bytes, const char* name);

  Gpu& gpu_;
  SingleSet& set_;
  TilesNeeds capacity_;
  std::array<GpuBuffer, 13> buffers_; // of the bindings of kBindings
};

} // namespace vitrail::tool
