// How the pool of a target with a memory budget follows what its frames need.
#pragma once

#include <cstdint>

#include "vitrail/types.h"

namespace vitrail {

// Nodes that a pool has beyond what its frames need and the room for somewhat more.
constexpr std::uint32_t kSpareNodes = 1024;

class Growth {
 public:
  // Whether the statistics of a frame are news.
  [[nodiscard]] bool isNews(std::uint64_t frame) const { return frame + 1 > newestFrame_; }

  // The capacity that a pool of `capacity` nodes should have after a frame with these statistics, at most `most`: more
  // at once where it was too small, less where the need has stayed below a quarter of it for 120 frames.
  std::uint32_t wanted(const VitrailStats& stats, std::uint32_t capacity, std::uint32_t most);

  // The need of before says nothing of another extent.
  void forget() { *this = {}; }

 private:
  std::uint64_t newestFrame_ = 0; // that was looked at, + 1
  std::uint32_t lowFrames_ = 0;   // in a row that needed less than a quarter of the pool
  std::uint64_t lowMost_ = 0;     // the most that any of those needed
};

} // namespace vitrail
