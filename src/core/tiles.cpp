// The C interface of tiles.h.
#include "vitrail/tiles.h"

#include <algorithm>
#include <memory>
#include <new>
#include <vector>

#include "log.h"
#include "pool.h"
#include "statistics.h"
#include "tile_plan.h"

struct VitrailTilePlan_T {
  vitrail::Log log;
  vitrail::TilePlanner plan;
};

namespace vitrail {

namespace {

constexpr std::uint64_t kLeastBudget = 64 * 1024;

std::vector<ClipBox> clipBoxes(std::uint32_t count, const VitrailBounds* bounds) {
  std::vector<ClipBox> boxes(bounds != nullptr ? count : 0);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    std::copy(bounds[i].min, bounds[i].min + 3, boxes[i].min.begin());
    std::copy(bounds[i].max, bounds[i].max + 3, boxes[i].max.begin());
    std::copy(bounds[i].clipFromBox, bounds[i].clipFromBox + 16, boxes[i].clipFromBox.begin());
  }
  return boxes;
}

VitrailRect toRect(const Rectangle& r) { return {r.x, r.y, r.width, r.height}; }

TilePlanInfo planInfo(const VitrailTilePlanDesc& desc) {
  TilePlanInfo info;
  info.area = {0, 0, desc.width, desc.height};
  if (desc.boundsCount > 0) {
    info.area = projectBounds(clipBoxes(desc.boundsCount, desc.bounds), desc.width, desc.height);
  }
  info.format = desc.nodeFormat;
  info.userWords = desc.userWords != 0;
  info.samples = desc.samples != 0 ? desc.samples : 1;
  // The target keeps its statistics beside the buffer.
  constexpr std::uint64_t kBeside = statisticsBytes(VITRAIL_MAX_FRAMES_IN_FLIGHT);
  info.memoryBudget = std::min(desc.memoryBudget - kBeside, desc.limits.memoryBytes);
  info.areaPixelsLimit = std::min<std::uint32_t>(desc.limits.areaPixels, VITRAIL_LIST_BUILD_COMPUTE_MAX_PIXELS);
  info.alignment = desc.limits.alignment;
  // The device's limit is one of bytes, and is told for nodes without words.
  const std::uint64_t nodes =
      std::uint64_t{desc.limits.nodeCapacity} * nodeBytes(desc.nodeFormat) / nodeBytes(desc.nodeFormat, info.userWords);
  info.nodeCapacityLimit =
      std::min(static_cast<std::uint32_t>(nodes), maxNodeIndexCount(desc.nodeFormat, info.samples));
  info.expectedFragments = desc.expectedFragments;
  return info;
}

VitrailResult checkPlan(const Log& log, const VitrailTilePlanDesc& desc) {
  if (desc.next != nullptr || desc.limits.next != nullptr) {
    return log.fail(VITRAIL_ERROR_INVALID, "VitrailTilePlanDesc::next: this version knows no further structures");
  }
  if (desc.width == 0 || desc.height == 0) {
    return log.fail(VITRAIL_ERROR_INVALID, "extent %ux%u: both sides must be at least 1", desc.width, desc.height);
  }
  const VitrailTileLimits& limits = desc.limits;
  if (limits.memoryBytes == 0 || limits.alignment == 0 || limits.nodeCapacity == 0 || limits.areaPixels == 0) {
    return log.fail(VITRAIL_ERROR_INVALID, "VitrailTilePlanDesc::limits is not filled in: ask vitrailVkTileLimits()");
  }
  if (desc.boundsCount > 0 && desc.bounds == nullptr) {
    return log.fail(VITRAIL_ERROR_INVALID, "boundsCount is %u, and bounds is null", desc.boundsCount);
  }
  if (nodeBytes(desc.nodeFormat) == 0) {
    return log.fail(VITRAIL_ERROR_INVALID, "nodeFormat %d is none of VitrailNodeFormat", desc.nodeFormat);
  }
  if (desc.memoryBudget < kLeastBudget) {
    return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "memoryBudget %llu: tiles need at least 65536 bytes",
                    static_cast<unsigned long long>(desc.memoryBudget));
  }
  const std::uint32_t samples = desc.samples != 0 ? desc.samples : 1;
  if (maxNodeIndexCount(desc.nodeFormat, samples) == 0) {
    return log.fail(VITRAIL_ERROR_FORMAT, "nodeFormat %d has no nodes at %u samples", desc.nodeFormat, samples);
  }
  return VITRAIL_SUCCESS;
}

} // namespace

} // namespace vitrail

extern "C" VitrailResult vitrailCreateTilePlan(const VitrailTilePlanDesc* desc, VitrailTilePlan* plan) {
  if (plan != nullptr) *plan = nullptr;
  const vitrail::Log log = desc != nullptr ? vitrail::Log{desc->log, desc->logUser} : vitrail::Log{};
  if (desc == nullptr || plan == nullptr) {
    return log.fail(VITRAIL_ERROR_INVALID, "vitrailCreateTilePlan: an argument is null");
  }
  const VitrailResult result = vitrail::checkPlan(log, *desc);
  if (result != VITRAIL_SUCCESS) return result;
  std::unique_ptr<VitrailTilePlan_T> made(new (std::nothrow)
                                              VitrailTilePlan_T{log, vitrail::TilePlanner(vitrail::planInfo(*desc))});
  if (!made) return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no memory for a tile plan");
  *plan = made.release();
  return VITRAIL_SUCCESS;
}

extern "C" void vitrailDestroyTilePlan(VitrailTilePlan plan) { std::default_delete<VitrailTilePlan_T>()(plan); }

extern "C" uint32_t vitrailTilePlanNodeCapacity(VitrailTilePlan plan) {
  return plan != nullptr ? plan->plan.nodeCapacity() : 0;
}

extern "C" uint32_t vitrailTilePlanAreaPixels(VitrailTilePlan plan) {
  return plan != nullptr ? plan->plan.areaPixels() : 0;
}

extern "C" uint32_t vitrailNextTile(VitrailTilePlan plan, VitrailRect* tile) {
  if (tile != nullptr) *tile = {};
  if (plan == nullptr || tile == nullptr) return 0;
  vitrail::Rectangle next;
  if (!plan->plan.next(next)) return 0;
  *tile = vitrail::toRect(next);
  return 1;
}

extern "C" VitrailResult vitrailFinishTile(VitrailTilePlan plan, const VitrailStats* stats) {
  if (plan == nullptr) return VITRAIL_ERROR_INVALID;
  if (stats == nullptr) return plan->log.fail(VITRAIL_ERROR_INVALID, "vitrailFinishTile: stats is null");
  if (stats->misused != 0) {
    return plan->log.fail(VITRAIL_ERROR_INVALID,
                          "vitrailFinishTile: the tile's frame was recorded wrongly, see the log");
  }
  if (stats->fragmentsMissing > 0 && stats->fragmentsRequested <= stats->nodeCapacity) {
    return plan->log.fail(
        VITRAIL_ERROR_INVALID,
        "vitrailFinishTile: fragments are missing though the pool had room: their shader does not suit "
        "the target");
  }
  if (plan->plan.finish(stats->fragmentsRequested, stats->fragmentsMissing, stats->nodeCapacity)) {
    return VITRAIL_SUCCESS;
  }
  return plan->log.fail(VITRAIL_ERROR_OUT_OF_MEMORY,
                        "one pixel has %llu fragments: that takes a memory budget of %llu bytes",
                        static_cast<unsigned long long>(stats->fragmentsRequested),
                        static_cast<unsigned long long>(plan->plan.bytesNeeded()));
}

extern "C" void vitrailProjectBounds(uint32_t count, const VitrailBounds* bounds, uint32_t width, uint32_t height,
                                     VitrailRect* area) {
  if (area == nullptr) return;
  *area = vitrail::toRect(vitrail::projectBounds(vitrail::clipBoxes(count, bounds), width, height));
}
