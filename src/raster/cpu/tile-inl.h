// A tile: opaque surfaces first, then the transparent ones over them.
#if defined(VITRAIL_TILE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_TILE_INL_H
#undef VITRAIL_TILE_INL_H
#else
#define VITRAIL_TILE_INL_H
#endif

#include <algorithm>

#include "raster/cpu/collect-inl.h"
#include "raster/cpu/finish-inl.h"
#include "raster/cpu/opaque-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

inline void TileWorker::draw(const Frame& frame, std::uint32_t tile, TileCounts& counts) {
  tile_.x = static_cast<std::int32_t>(tile % frame.tilesX * kTileSide);
  tile_.y = static_cast<std::int32_t>(tile / frame.tilesX * kTileSide);
  tile_.lastX = std::min<std::int32_t>(kTileSide, static_cast<std::int32_t>(frame.info.width) - tile_.x) - 1;
  tile_.lastY = std::min<std::int32_t>(kTileSide, static_cast<std::int32_t>(frame.info.height) - tile_.y) - 1;
  std::uint64_t blocks = 0;
  for (std::uint32_t b = 0; b < kBlocks; ++b) {
    // Columns and rows of the block that lie within the frame.
    const std::int32_t columns = tile_.lastX + 1 - static_cast<std::int32_t>(b % kBlocksAcross * kBlockSide);
    const std::int32_t rows = tile_.lastY + 1 - static_cast<std::int32_t>(b / kBlocksAcross * kBlockSide);
    const std::uint32_t row = columns <= 0 ? 0 : 0xfU >> std::max(4 - columns, 0);
    const std::uint32_t all = rows <= 0 ? 0 : 0xffffU >> 4 * std::max(4 - rows, 0);
    tile_.pixels[b] = static_cast<std::uint16_t>(row * 0x1111U & all);
    if (tile_.pixels[b] != 0) blocks |= std::uint64_t{1} << b;
  }
  demand_ = {};
  tracksHidden_ = false;
  if (!frame.needs.shaded) colors_.begin(frame);
  drawOpaque(frame, tile);
  takeNumbers(frame, tile, false);
  if (!orderByDepth(frame) && !orderLarge(frame)) merge();
  rowsBefore_ = 0;
  trianglesBefore_ = numbers_.size();
  if (!numbers_.empty() || (opaque_ != nullptr && opaque_->drawn != 0) || frame.info.sampleColors != nullptr) {
    untouched_ = 0;
    drawParts(frame, blocks, counts);
    if (tracksHidden_ && !frame.isFlat()) order_.learn(shownTriangles_ < numbers_.size() / 8 * 7);
    writeTile(frame);
  } else {
    untouched_ = blocks;
  }
  if (frame.info.clear != nullptr) {
    clearBlocks(frame, tile_, untouched_);
  } else if (frame.info.colorFormat == VITRAIL_CPU_RGBA8_SRGB) {
    setAlpha(frame, tile_, untouched_);
  }
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
