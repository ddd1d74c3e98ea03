// The memory of methods that keep a fixed number of layers for each pixel.
#pragma once

#include <cstdint>
#include <string>

#include "../../gpu/resources.h"

namespace vitrail::tool {

struct LayerMemoryInfo {
  std::string method;
  std::uint32_t layers = 0;
  std::uint64_t words = 0; // of 4 bytes, a pixel; less than 2^62
};

// A storage buffer that can be filled, for a picture of at least one pixel. Throws GpuError where a shader does not
// reach that much.
GpuBuffer makeLayerMemory(Gpu& gpu, VkExtent2D extent, const LayerMemoryInfo& info);

} // namespace vitrail::tool
