// What is known of a frame that was drawn: plain data, which report/ writes.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "../methods/frame_stats.h"

namespace vitrail::tool {

// The passes of a frame with their milliseconds, in order.
using PassTimes = std::vector<std::pair<std::string, double>>;

struct FrameReport : FrameStats {
  std::string device;
  std::string api;    // "Vulkan 1.3"
  std::string method; // "linked-list"
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 1;
  std::uint32_t peeled = 0;          // the nearest surfaces of each pixel that were left out, as was asked for
  std::string msaaResolve;           // "per-pixel", "per-sample"; empty at one sample and where `resolve` is
  std::vector<std::string> warnings; // what the picture lacks, or shows otherwise than its file says
  std::uint64_t peakBytes = 0;       // the most device memory that the tool and the library held at once
  // GPU time: opaque, the passes that the method names, encode. With fragment lists those are clear, collect, build
  // lists where that is a pass of its own, and resolve; unsorted has blend; a multisampled picture has box_filter
  // before encode. Summed over tiles. What the host works on a frame before the GPU can go on stands among them, as
  // sort. Empty, and frameMs 0, on devices without timestamps.
  PassTimes passesMs;
  double frameMs = 0.0; // of all passes
};

} // namespace vitrail::tool
