#include "statistics.h"

#include <algorithm>
#include <atomic>

#include "error_bound.h"

namespace vitrail {

namespace {

// Whether the commands that the host recorded for the frame ran, in their order: it began, no fragment came after its
// lists were collected, and what was stored was seen by the resolve.
bool ranInOrder(const StatsSlot& slot, const VitrailStats& stats) {
  const bool begun = slot.begunFrame == static_cast<std::uint32_t>(stats.frame);
  const bool collected = slot.control.collected == slot.control.requested;
  const bool seen = stats.fragmentsStored == 0 || stats.fragmentsMissing > 0 || stats.layersMax > 0;
  return begun && collected && seen;
}

void decode(const StatsSlot& slot, const NodeKind& nodes, VitrailStats& stats) {
  const layout::VitrailControl& control = slot.control;
  const FrameFacts& facts = slot.facts;
  stats.nodeCapacity = facts.nodeCapacity;
  const std::uint64_t requested = std::uint64_t{control.wraps} * layout::VITRAIL_WRAP_STEP + control.requested;
  stats.fragmentsRequested = requested + control.misfits;
  stats.fragmentsStored = std::min<std::uint64_t>(requested, stats.nodeCapacity) - control.misfitNodes;
  stats.fragmentsMissing = stats.fragmentsRequested - stats.fragmentsStored;
  stats.cutPixels = control.cutPixels;
  stats.approximatePixels = control.approximatePixels;
  stats.layersMax = control.layersMax;
  for (const std::uint32_t part : control.coveredPixels) stats.coveredPixels += part;
  stats.misused = facts.misused != 0 || !ranInOrder(slot, stats) ? 1 : 0;
  const bool whole = stats.fragmentsMissing == 0 && stats.cutPixels == 0 && stats.approximatePixels == 0;
  stats.complete = whole && stats.misused == 0 ? 1 : 0;
  stats.errorBound = nodeErrorBound(nodes.format, nodes.samples, stats.layersMax);
  stats.exact = stats.complete != 0 && stats.errorBound <= 1.0F ? 1 : 0;
}

} // namespace

bool readSlot(StatsSlot& slot, std::uint64_t frame, const NodeKind& nodes, VitrailStats& stats) {
  // The counters are read between two looks at the tag: the GPU may start to write the slot again at any time.
  const std::uint64_t tag = frame + 1;
  const std::atomic_ref<std::uint64_t> written(slot.tag);
  if (tag == 0 || written.load(std::memory_order_acquire) != tag) return false;
  const StatsSlot copy = slot;
  std::atomic_thread_fence(std::memory_order_acquire);
  if (written.load(std::memory_order_relaxed) != tag) return false;
  void* next = stats.next;
  stats = {};
  stats.next = next;
  stats.frame = frame;
  decode(copy, nodes, stats);
  return true;
}

} // namespace vitrail
