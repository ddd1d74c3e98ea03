// When the sums of missing fragments must be cleared: memory that is new holds anything, and a frame that was not
// resolved may leave sums. Frames that ran to their end clean up after themselves, so that most frames clear nothing.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "statistics.h"

namespace vitrail {

class SumsClear {
 public:
  // Memory that no frame has cleared yet.
  void reset() { clean_ = false; }

  // At the start of a frame: whether it must record a clear. Frames record it until one of them is seen to have run:
  // one that was recorded may never be submitted.
  bool begin(std::span<StatsSlot> slots) {
    if (!clean_) ++number_;
    clean_ = false; // until this frame has been resolved
    for (StatsSlot& slot : slots) {
      if (std::atomic_ref(slot.facts.sumsCleared).load(std::memory_order_relaxed) == number_) return false;
    }
    return true;
  }

  // The frame's resolve has cleaned up.
  void cleaned() { clean_ = true; }

  // FrameFacts::sumsCleared.
  [[nodiscard]] std::uint32_t fact() const { return clean_ ? number_ : 0; }

 private:
  std::uint32_t number_ = 0; // of the clear that the sums need
  bool clean_ = false;       // once all that was recorded has run
};

} // namespace vitrail
