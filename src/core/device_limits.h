// What a device can do, as far as it matters to fragment lists; each backend fills it in.
#pragma once

#include <cstdint>

namespace vitrail {

struct DeviceLimits {
  std::uint64_t storageBufferRange = 0; // bytes of a buffer that shaders reach through one binding
  std::uint64_t allocationSize = 0;
  std::uint64_t heapSize = 0;     // the largest device-local one
  std::uint64_t alignment = 1;    // of every part of a target's buffer
  std::uint32_t sampleCounts = 0; // that colour, depth and sampled images share: the sum of 1, 2, 4 and 8
  bool isCpu = false;             // a driver that runs on the CPU
  bool exchangesInGroups = false; // compute shaders exchange values within at least 8 invocations
  bool fillsSlowly = false;       // a kernel fills buffers faster than the API does
  bool fewFragmentCores = false;  // a GPU that runs fragment shaders on a small part of its cores
  // Of what the host has enabled:
  bool poolByAddress = false; // the pool is reached by its address, whatever its size
  bool dualSourceBlending = false;
  bool sampleShading = false;

  // How lists are sorted: by networks on GPUs, by insertion, whose code is short, where both sides of every branch are
  // executed. Set by the tests, too.
  bool networks = true;
  // A raster has one pipeline that blends for tiles of all classes.
  bool oneBlend = false;
};

} // namespace vitrail
