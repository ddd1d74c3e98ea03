// The host's arrays, a block of 4 x 4 pixels at a time. Pixels beyond the picture's border read as its last ones and
// are not written.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/cpu/frame.h"

namespace vitrail::raster {

struct PixelBlock {
  alignas(64) float color[4][kBlockPixels]; // linear, premultiplied r, g, b, alpha
};

// What is behind a sample of each pixel: the host's colour, or that of the sample.
void readPixels(const Frame& frame, const TileBox& tile, std::uint32_t block, std::uint32_t sample, PixelBlock& pixels);
// Where the frame has a colour that is behind all draws: gives it to all pixels of some blocks, a bit each.
void clearBlocks(const Frame& frame, const TileBox& tile, std::uint64_t blocks);
// 8-bit pictures have an alpha of 255 also where nothing is drawn.
void setAlpha(const Frame& frame, const TileBox& tile, std::uint64_t blocks);
void writePixels(const Frame& frame, const TileBox& tile, std::uint32_t block, const PixelBlock& pixels);

// A sample's depth of each pixel. Only the pixels of `mask` are written.
void readDepths(const Frame& frame, const TileBox& tile, std::uint32_t block, std::uint32_t sample, float* depths);
void writeDepths(const Frame& frame, const TileBox& tile, std::uint32_t block, std::uint32_t sample,
                 const float* depths, std::uint32_t mask);

// A fragment as layers of a list: one, or two where it has a filter. `pair` and `filter` are what it does to the light
// behind it; `layer` has the rest.
void appendLayers(const VitrailCpuDraw& draw, const float* pair, const float* filter, const VitrailLayer& layer,
                  std::vector<VitrailLayer>& layers);

} // namespace vitrail::raster
