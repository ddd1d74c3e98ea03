#include "statistics.h"

#include <algorithm>
#include <atomic>

namespace vitrail {

namespace {

void decode(const layout::VitrailControl& control, const FrameFacts& facts, VitrailStats& stats) {
  stats.nodeCapacity = facts.nodeCapacity;
  const std::uint64_t requested = std::uint64_t{control.wraps} * layout::VITRAIL_WRAP_STEP + control.requested;
  stats.fragmentsRequested = requested + control.misfits;
  stats.fragmentsStored = std::min<std::uint64_t>(requested, stats.nodeCapacity) - control.misfitNodes;
  stats.fragmentsMissing = stats.fragmentsRequested - stats.fragmentsStored;
  stats.cutPixels = control.cutPixels;
  stats.approximatePixels = control.approximatePixels;
  stats.misused = facts.misused;
  const bool whole = stats.fragmentsMissing == 0 && stats.cutPixels == 0 && stats.approximatePixels == 0;
  stats.exact = whole && stats.misused == 0 ? 1 : 0;
  stats.layersMax = control.layersMax;
  for (const std::uint32_t part : control.coveredPixels) stats.coveredPixels += part;
}

} // namespace

bool readSlot(StatsSlot& slot, std::uint64_t frame, VitrailStats& stats) {
  // The counters are read between two looks at the tag: the GPU may start to write the slot again at any time.
  const std::uint64_t tag = frame + 1;
  const std::atomic_ref<std::uint64_t> written(slot.tag);
  if (tag == 0 || written.load(std::memory_order_acquire) != tag) return false;
  const layout::VitrailControl control = slot.control;
  const FrameFacts facts = slot.facts;
  std::atomic_thread_fence(std::memory_order_acquire);
  if (written.load(std::memory_order_relaxed) != tag) return false;
  void* next = stats.next;
  stats = {};
  stats.next = next;
  stats.frame = frame;
  decode(control, facts, stats);
  return true;
}

} // namespace vitrail
