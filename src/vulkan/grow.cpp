// How the pool of a target with a memory budget follows what its frames need.
#include <algorithm>

#include "check_target.h"
#include "target.h"

namespace vitrail {

namespace {

constexpr std::uint32_t kLowFrames = 120; // in a row, before the pool shrinks

// With room for frames that need somewhat more than this one.
std::uint32_t withRoom(std::uint64_t nodes, std::uint32_t numerator, std::uint32_t denominator, std::uint32_t most) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(nodes * numerator / denominator + 1024, most));
}

// The statistics of the newest finished frame that was not looked at yet.
bool readNewest(VitrailTarget_T& target, std::uint64_t frame, VitrailStats* stats) {
  for (std::uint64_t back = 1; back <= target.desc.framesInFlight && back <= frame; ++back) {
    const std::uint64_t past = frame - back;
    if (past + 1 <= target.demand.newestFrame) return false;
    if (vitrailReadStats(&target, past, stats) != VK_SUCCESS) continue;
    target.demand.newestFrame = past + 1;
    return true;
  }
  return false;
}

// The capacity that the pool should have after a frame.
std::uint32_t wantedCapacity(VitrailTarget_T& target, const VitrailStats& stats, std::uint32_t most) {
  Demand& demand = target.demand;
  const std::uint32_t capacity = target.storage.nodeCapacity;
  if (stats.fragmentsRequested > capacity) {
    demand.lowFrames = 0;
    return withRoom(stats.fragmentsRequested, 5, 4, most);
  }
  if (stats.fragmentsRequested >= capacity / 4) {
    demand.lowFrames = 0;
    return capacity;
  }
  demand.lowMost =
      demand.lowFrames == 0 ? stats.fragmentsRequested : std::max(demand.lowMost, stats.fragmentsRequested);
  if (++demand.lowFrames < kLowFrames) return capacity;
  demand.lowFrames = 0;
  return std::min(capacity, withRoom(demand.lowMost, 3, 2, most));
}

} // namespace

} // namespace vitrail

extern "C" VkResult vitrailUpdateTarget(VitrailTarget target, uint64_t frame) {
  vitrail::freeRetired(*target, frame);
  if (target->desc.memoryBudget == 0) return VK_SUCCESS;
  VitrailStats stats{};
  if (!vitrail::readNewest(*target, frame, &stats)) return VK_SUCCESS;
  const std::uint32_t most = vitrail::budgetCapacity(target->context, target->desc, target->desc.areaPixels);
  const std::uint32_t wanted = vitrail::wantedCapacity(*target, stats, most);
  if (wanted == target->storage.nodeCapacity) return VK_SUCCESS;
  return vitrail::replaceStorage(*target, vitrail::storageInfo(*target, wanted), frame);
}
