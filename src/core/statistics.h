// What the GPU leaves behind of a frame for the host, and how that is read.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vitrail/layout.h"
#include "vitrail/types.h"

namespace vitrail {

// What decides how nodes round.
struct NodeKind {
  std::uint32_t format;
  std::uint32_t samples;
};

// What the host knows of a frame when it records it.
struct FrameFacts {
  std::uint32_t nodeCapacity; // of the pool that the frame uses
  std::uint32_t misused;      // 1: calls were missing or wrong
  // The number of the clear that its sums needed (sums_clear.h); 0 where it leaves them dirty.
  std::uint32_t sumsCleared;
};

// StatsSlot::begunFrame before the first frame.
constexpr std::uint32_t kNoFrame = 0xffffffffU;

// The memory that one frame's counters are copied to. The tag is 0 from the start of a frame until its counters are
// there: a slot whose tag is right, before and after the counters are read, is whole.
struct StatsSlot {
  layout::VitrailControl control;
  std::uint32_t
      begunFrame;    // VitrailParameters::frame as the GPU has it: another one's if this frame's begin did not run
  FrameFacts facts;  // `sumsCleared` is read without the tag
  std::uint64_t tag; // frame + 1, so that a slot never written names no frame
};
static_assert(offsetof(StatsSlot, tag) == sizeof(layout::VitrailControl) + 4 + sizeof(FrameFacts)); // no hidden gaps

// One slot more than frames in flight: a host reads frame n - framesInFlight when it has waited for it, and by then it
// may have recorded frame n.
constexpr std::uint32_t statisticsSlots(std::uint32_t framesInFlight) { return framesInFlight + 1; }
constexpr std::uint64_t statisticsBytes(std::uint32_t framesInFlight) {
  return statisticsSlots(framesInFlight) * sizeof(StatsSlot);
}

// Reads a slot that the GPU may be writing to, of a target with such nodes. False: it does not hold that frame (any
// more). `next` of the statistics stays.
bool readSlot(StatsSlot& slot, std::uint64_t frame, const NodeKind& nodes, VitrailStats& stats);

} // namespace vitrail
