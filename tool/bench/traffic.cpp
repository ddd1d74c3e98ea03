#include "traffic.h"

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kHeadBytes = 4;
constexpr std::uint64_t kColorBytes = 8;

} // namespace

std::uint64_t leastBytes(const FrameShape& frame) {
  const std::uint64_t heads = 2 * kHeadBytes * frame.pixels + 2 * kHeadBytes * frame.coveredPixels;
  const std::uint64_t nodes = 2 * frame.fragments * frame.nodeBytes;
  const std::uint64_t color =
      frame.samples == 1 ? 2 * kColorBytes * frame.coveredPixels : (frame.samples + 1) * kColorBytes * frame.pixels;
  return heads + nodes + color;
}

} // namespace vitrail::tool
