// What the GPU reported about a past frame.
#include <atomic>

#include "target.h"

extern "C" VkResult vitrailReadStats(VitrailTarget target, uint64_t frame, VitrailStats* stats) {
  auto* slot =
      reinterpret_cast<vitrail::StatsSlot*>(static_cast<char*>(target->stats.mapped) + target->slotOffset(frame));
  // The counters are read between two looks at the tag: the GPU may start to write the slot again at any time.
  const std::uint64_t tag = frame + 1;
  const std::atomic_ref<std::uint64_t> written(slot->tag);
  if (tag == 0 || written.load(std::memory_order_acquire) != tag) return VK_NOT_READY;
  const vitrail::layout::VitrailControl control = slot->control;
  std::atomic_thread_fence(std::memory_order_acquire);
  if (written.load(std::memory_order_relaxed) != tag) return VK_NOT_READY;
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
