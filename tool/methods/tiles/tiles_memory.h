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
  TilesMemory(Gpu& gpu, SingleSet& set, std::uint32_t samples);

  // Makes room for bands of at most so many tiles. No frame is pending, for this and the next ones. `budget` in bytes.
  // Throws GpuError.
  void setTiles(std::uint32_t tiles, std::uint64_t budget);
  // Makes room for what is needed and not there, with some to spare, and says by how many times that is too much: for
  // what a shader reaches, or for the budget. Where it is (1 and more) it makes none. Throws GpuError where the device
  // has no memory for it.
  double grow(const TilesNeeds& needs);
  void release();

  const TilesNeeds& capacity() const { return capacity_; }
  const GpuBuffer& tileRecords() const { return buffers_[0]; }
  const GpuBuffer& deepPixels() const { return buffers_[7]; }
  std::uint64_t bytes() const;

 private:
  double excess(const TilesNeeds& needs) const;
  void resize(const TilesNeeds& next);
  std::uint64_t maskBytes() const { return samples_ > 1 ? samples_ * 8 : 0; }    // of a record
  std::uint64_t stateBytes() const { return std::uint64_t{samples_} * 64 * 32; } // of a deep tile
  void make(std::uint32_t binding, std::uint64_t bytes, const char* name);

  Gpu& gpu_;
  SingleSet& set_;
  std::uint32_t samples_;
  std::uint64_t budget_ = 0;
  std::uint32_t tiles_ = 0;
  TilesNeeds capacity_;
  std::array<GpuBuffer, 14> buffers_; // of the bindings of kBindings
};

} // namespace vitrail::tool
