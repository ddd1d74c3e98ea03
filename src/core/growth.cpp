#include "growth.h"

#include <algorithm>

namespace vitrail {

namespace {

constexpr std::uint32_t kLowFrames = 120; // in a row, before the pool shrinks

// With room for frames that need somewhat more than this one.
std::uint32_t withRoom(std::uint64_t nodes, std::uint32_t numerator, std::uint32_t denominator, std::uint32_t most) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(nodes * numerator / denominator + kSpareNodes, most));
}

} // namespace

std::uint32_t Growth::wanted(const VitrailStats& stats, std::uint32_t capacity, std::uint32_t most) {
  newestFrame_ = stats.frame + 1;
  if (stats.fragmentsRequested > capacity) {
    lowFrames_ = 0;
    return withRoom(stats.fragmentsRequested, 5, 4, most);
  }
  if (stats.fragmentsRequested >= capacity / 4) {
    lowFrames_ = 0;
    return capacity;
  }
  lowMost_ = lowFrames_ == 0 ? stats.fragmentsRequested : std::max(lowMost_, stats.fragmentsRequested);
  if (++lowFrames_ < kLowFrames) return capacity;
  lowFrames_ = 0;
  return std::min(capacity, withRoom(lowMost_, 3, 2, most));
}

} // namespace vitrail
