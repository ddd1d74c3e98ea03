// The bytes that a frame cannot do without moving: the floor under its time. Of methods with per-pixel linked lists,
// and of the rasteriser in compute shaders.
#pragma once

#include <cstdint>

#include "../methods/frame_stats.h"

namespace vitrail::tool {

// A frame of one sample a pixel, or of several that are resolved to one colour a pixel.
struct FrameShape {
  std::uint64_t pixels = 0;
  std::uint64_t coveredPixels = 0; // with at least one fragment
  std::uint64_t fragments = 0;
  std::uint32_t nodeBytes = 0;
  std::uint32_t samples = 1;
};

// The sum of
//   heads    4 bytes a pixel cleared, and read by the resolve; 8 bytes a covered pixel read and written by the collect
//            pass (more exchanges of one head can stay in a cache)
//   nodes    each written once and read once
//   colour   8 bytes a sample (R16G16B16A16_SFLOAT). One sample: read and written where a pixel is covered; several:
//   all
//            samples of every pixel read, one colour a pixel written
// Geometry, textures, the depth test, sorting outside registers and counters come on top and are not counted.
std::uint64_t leastBytes(const FrameShape& frame);

// The same of a frame that was rasterised by tiles (shaders/vitrail/raster/), whose fragments are never stored:
//   vertices   44 bytes: read (three floats), the place written and read
//   triangles  12 bytes: the indices
//   records    104 bytes, of several samples 16 more for each: written with its tile (44), put in order by tile (20),
//              read (40)
//   colour     as above, and 4 bytes a sample of opaque depth where a pixel is covered
// `coveredPixels` may be 0, where nothing has counted them.
std::uint64_t leastRasterBytes(const FrameShape& frame, const RasterCounts& counts);

} // namespace vitrail::tool
