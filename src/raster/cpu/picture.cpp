#include "raster/cpu/picture.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "raster/cpu/srgb.h"

namespace vitrail::raster {

namespace {

struct Place {
  std::uint32_t x;
  std::uint32_t y;
  bool isInside;
};

Place placeOf(const Frame& frame, const TileBox& tile, std::uint32_t block, std::uint32_t pixel) {
  constexpr std::uint32_t kAcross = kTileSide / kBlockSide;
  const std::uint32_t x = static_cast<std::uint32_t>(tile.x) + block % kAcross * kBlockSide + pixel % kBlockSide;
  const std::uint32_t y = static_cast<std::uint32_t>(tile.y) + block / kAcross * kBlockSide + pixel / kBlockSide;
  const std::uint32_t lastX = frame.info.width - 1;
  const std::uint32_t lastY = frame.info.height - 1;
  return {std::min(x, lastX), std::min(y, lastY), x <= lastX && y <= lastY};
}

template <class T>
T* rowOf(void* array, std::uint32_t stride, std::uint32_t y) {
  return reinterpret_cast<T*>(static_cast<unsigned char*>(array) + std::size_t{stride} * y);
}

// Calls run(x, y, count) for each row of pixels side by side in some of a tile's blocks, a bit each.
template <class Run>
void forRuns(const TileBox& tile, std::uint64_t blocks, Run run) {
  constexpr std::uint32_t kAcross = kTileSide / kBlockSide;
  for (std::uint32_t y = 0; y <= static_cast<std::uint32_t>(tile.lastY); ++y) {
    auto row = static_cast<std::uint32_t>(blocks >> y / kBlockSide * kAcross & 0xffU);
    while (row != 0) { // each run of blocks
      const auto first = static_cast<std::uint32_t>(std::countr_zero(row));
      const auto end = first + static_cast<std::uint32_t>(std::countr_one(row >> first));
      row &= ~(((1U << (end - first)) - 1U) << first);
      const std::uint32_t x = first * kBlockSide;
      const std::uint32_t count = std::min(end * kBlockSide, static_cast<std::uint32_t>(tile.lastX) + 1) - x;
      run(static_cast<std::uint32_t>(tile.x) + x, static_cast<std::uint32_t>(tile.y) + y, count);
    }
  }
}

} // namespace

void readPixels(const Frame& frame, const TileBox& tile, std::uint32_t block, std::uint32_t sample,
                PixelBlock& pixels) {
  const VitrailCpuFrame& info = frame.info;
  for (std::uint32_t i = 0; i < kBlockPixels; ++i) {
    const Place at = placeOf(frame, tile, block, i);
    float color[4];
    if (info.clear != nullptr) {
      std::memcpy(color, info.clear, sizeof(color));
      if (info.colorFormat == VITRAIL_CPU_RGBA8_SRGB) color[3] = 1.0F;
    } else if (info.sampleColors != nullptr) {
      const std::size_t pixel = std::size_t{at.y} * info.width + at.x;
      std::memcpy(color, info.sampleColors + (pixel * info.samples + sample) * 4, sizeof(color));
    } else if (info.colorFormat == VITRAIL_CPU_RGBA32F) {
      std::memcpy(color, rowOf<float>(info.color, info.colorStride, at.y) + std::size_t{at.x} * 4, sizeof(color));
    } else {
      const auto* bytes = rowOf<std::uint8_t>(info.color, info.colorStride, at.y) + std::size_t{at.x} * 4;
      for (std::size_t c = 0; c < 3; ++c) color[c] = srgbTables().linear[bytes[c]];
      color[3] = 1.0F;
    }
    for (std::size_t c = 0; c < 4; ++c) pixels.color[c][i] = color[c];
  }
}

void clearBlocks(const Frame& frame, const TileBox& tile, std::uint64_t blocks) {
  const VitrailCpuFrame& info = frame.info;
  std::uint8_t code[4] = {0, 0, 0, 255};
  if (info.colorFormat == VITRAIL_CPU_RGBA8_SRGB) {
    for (std::size_t c = 0; c < 3; ++c) code[c] = srgbTables().encode(info.clear[c]);
  }
  const auto fill = [](auto* to, const auto* pixel, std::uint32_t count) {
    for (std::uint32_t x = 0; x < count; ++x, to += 4) std::memcpy(to, pixel, 4 * sizeof(*pixel));
  };
  forRuns(tile, blocks, [&](std::uint32_t x, std::uint32_t y, std::uint32_t count) {
    const std::size_t at = std::size_t{x} * 4;
    if (info.colorFormat == VITRAIL_CPU_RGBA32F) {
      fill(rowOf<float>(info.color, info.colorStride, y) + at, info.clear, count);
    } else {
      fill(rowOf<std::uint8_t>(info.color, info.colorStride, y) + at, code, count);
    }
  });
}

void setAlpha(const Frame& frame, const TileBox& tile, std::uint64_t blocks) {
  const VitrailCpuFrame& info = frame.info;
  forRuns(tile, blocks, [&](std::uint32_t x, std::uint32_t y, std::uint32_t count) {
    auto* alpha = rowOf<std::uint8_t>(info.color, info.colorStride, y) + std::size_t{x} * 4 + 3;
    for (std::uint32_t i = 0; i < count; ++i) alpha[std::size_t{i} * 4] = 255;
  });
}

void writePixels(const Frame& frame, const TileBox& tile, std::uint32_t block, const PixelBlock& pixels) {
  const VitrailCpuFrame& info = frame.info;
  for (std::uint32_t i = 0; i < kBlockPixels; ++i) {
    const Place at = placeOf(frame, tile, block, i);
    if (!at.isInside) continue;
    if (info.colorFormat == VITRAIL_CPU_RGBA32F) {
      float* to = rowOf<float>(info.color, info.colorStride, at.y) + std::size_t{at.x} * 4;
      for (std::size_t c = 0; c < 4; ++c) to[c] = pixels.color[c][i];
    } else {
      auto* to = rowOf<std::uint8_t>(info.color, info.colorStride, at.y) + std::size_t{at.x} * 4;
      for (std::size_t c = 0; c < 3; ++c) to[c] = srgbTables().encode(pixels.color[c][i]);
      to[3] = 255;
    }
  }
}

void readDepths(const Frame& frame, const TileBox& tile, std::uint32_t block, std::uint32_t sample, float* depths) {
  const VitrailCpuFrame& info = frame.info;
  for (std::uint32_t i = 0; i < kBlockPixels; ++i) {
    const Place at = placeOf(frame, tile, block, i);
    depths[i] = rowOf<float>(info.depth, info.depthStride, at.y)[std::size_t{at.x} * info.samples + sample];
  }
}

void writeDepths(const Frame& frame, const TileBox& tile, std::uint32_t block, std::uint32_t sample,
                 const float* depths, std::uint32_t mask) {
  const VitrailCpuFrame& info = frame.info;
  for (std::uint32_t i = 0; i < kBlockPixels; ++i) {
    const Place at = placeOf(frame, tile, block, i);
    if (!at.isInside || (mask >> i & 1U) == 0) continue;
    rowOf<float>(info.depth, info.depthStride, at.y)[std::size_t{at.x} * info.samples + sample] = depths[i];
  }
}

void appendLayers(const VitrailCpuDraw& draw, const float* pair, const float* filter, const VitrailLayer& layer,
                  std::vector<VitrailLayer>& layers) {
  VitrailLayer made = layer;
  const float alpha = pair[3];
  switch (draw.blend) {
    case VITRAIL_BLEND_MULTIPLY:
      for (std::size_t c = 0; c < 3; ++c) made.color[c] = filter[c];
      made.color[3] = 1.0F;
      break;
    case VITRAIL_BLEND_ADDITIVE:
      for (std::size_t c = 0; c < 3; ++c) made.color[c] = pair[c];
      made.color[3] = 1.0F;
      break;
    default:
      for (std::size_t c = 0; c < 3; ++c) {
        made.color[c] = draw.blend == VITRAIL_BLEND_OVER && alpha > 0.0F ? pair[c] / alpha : pair[c];
      }
      made.color[3] = alpha;
  }
  layers.push_back(made);
  if ((draw.shadeFlags & VITRAIL_CPU_SHADE_FILTER) == 0) return;
  made.blend = VITRAIL_BLEND_MULTIPLY;
  for (std::size_t c = 0; c < 3; ++c) made.color[c] = alpha < 1.0F ? filter[c] / (1.0F - alpha) : 1.0F;
  made.color[3] = 1.0F;
  layers.push_back(made);
}

} // namespace vitrail::raster
