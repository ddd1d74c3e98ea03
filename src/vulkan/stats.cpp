// What the GPU reported about a past frame.
#include <atomic>

#include "target.h"

extern "C" VkResult vitrailReadStats(VitrailTarget target, uint64_t frame, VitrailStats* stats) {
  auto* slot =
      reinterpret_cast<vitrail::StatsSlot*>(static_cast<char*>(target->stats.mapped) + target->slotOffset(frame));
  // Acquire: the counters are read after the tag that says that they are there.
  if (std::atomic_ref(slot->tag).load(std::memory_order_acquire) != frame + 1) return VK_NOT_READY;
  const vitrail::layout::VitrailControl control = slot->control;
  *stats = {};
  stats->frame = frame;
  stats->fragmentsStored = control.stored;
  stats->fragmentsMissing = (std::uint64_t{control.missingHigh} << 32U) | control.missingLow;
  stats->fragmentsRequested = stats->fragmentsStored + stats->fragmentsMissing;
  stats->cutPixels = control.cutPixels;
  stats->exact = stats->fragmentsMissing == 0 && stats->cutPixels == 0 ? 1 : 0;
  stats->layersMax = control.layersMax;
  stats->coveredPixels = control.coveredPixels;
  return VK_SUCCESS;
}
