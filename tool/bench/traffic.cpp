#include "traffic.h"

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kHeadBytes = 4;
constexpr std::uint64_t kColorBytes = 8;
constexpr std::uint64_t kDepthBytes = 4;

std::uint64_t colorBytes(const FrameShape& frame) {
  return frame.samples == 1 ? 2 * kColorBytes * frame.coveredPixels : (frame.samples + 1) * kColorBytes * frame.pixels;
}

} // namespace

std::uint64_t leastBytes(const FrameShape& frame) {
  const std::uint64_t heads = 2 * kHeadBytes * frame.pixels + 2 * kHeadBytes * frame.coveredPixels;
  const std::uint64_t nodes = 2 * frame.fragments * frame.nodeBytes;
  return heads + nodes + colorBytes(frame);
}

std::uint64_t leastRasterBytes(const FrameShape& frame, const RasterCounts& counts) {
  const std::uint64_t record = 64 + (frame.samples > 1 ? 16 * frame.samples : 0);
  const std::uint64_t depth = kDepthBytes * frame.samples * frame.coveredPixels;
  return 44 * counts.vertices + 12 * counts.triangles + record * counts.records + colorBytes(frame) + depth;
}

} // namespace vitrail::tool
