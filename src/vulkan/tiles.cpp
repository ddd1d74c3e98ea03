// The tile planner of src/core behind the C interface.
#include <algorithm>
#include <memory>
#include <new>
#include <vector>

#include "context.h"
#include "core/pool.h"
#include "core/tile_plan.h"
#include "target.h"

struct VitrailTilePlan_T {
  VitrailContext context = nullptr;
  vitrail::TilePlan plan;
};

namespace vitrail {

namespace {

constexpr VkDeviceSize kLeastBudget = 64 * 1024;

std::vector<ClipBox> clipBoxes(std::uint32_t count, const VitrailBounds* bounds) {
  std::vector<ClipBox> boxes(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::copy(bounds[i].min, bounds[i].min + 3, boxes[i].min.begin());
    std::copy(bounds[i].max, bounds[i].max + 3, boxes[i].max.begin());
    std::copy(bounds[i].clipFromBox, bounds[i].clipFromBox + 16, boxes[i].clipFromBox.begin());
  }
  return boxes;
}

VkRect2D toRect(const Rectangle& r) {
  return {{static_cast<std::int32_t>(r.x), static_cast<std::int32_t>(r.y)}, {r.width, r.height}};
}

TilePlanInfo planInfo(VitrailContext context, const VitrailTilePlanDesc& desc) {
  const Limits& limits = context->limits;
  TilePlanInfo info;
  info.area = {0, 0, desc.extent.width, desc.extent.height};
  if (desc.boundsCount > 0) {
    info.area = projectBounds(clipBoxes(desc.boundsCount, desc.bounds), desc.extent.width, desc.extent.height);
  }
  info.format = desc.nodeFormat;
  info.samples = desc.samples != 0 ? desc.samples : 1;
  // The target keeps its statistics beside the buffer.
  constexpr VkDeviceSize kBeside = VITRAIL_MAX_FRAMES_IN_FLIGHT * sizeof(StatsSlot);
  info.memoryBudget = std::min({desc.memoryBudget - kBeside, limits.allocationSize, limits.heapSize});
  info.areaPixelsLimit = static_cast<std::uint32_t>(
      std::min<std::uint64_t>(limits.storageBufferRange / sizeof(layout::uint), VITRAIL_MAX_PIXELS_LINKED_BY_COMPUTE));
  info.alignment = limits.alignment;
  info.nodeCapacityLimit =
      vitrailMaxNodeCapacity(context, desc.nodeFormat, static_cast<VkSampleCountFlagBits>(info.samples));
  info.expectedFragments = desc.expectedFragments;
  return info;
}

} // namespace

} // namespace vitrail

extern "C" VkResult vitrailCreateTilePlan(VitrailContext context, const VitrailTilePlanDesc* desc,
                                          VitrailTilePlan* plan) {
  *plan = nullptr;
  if (desc->extent.width == 0 || desc->extent.height == 0) {
    return context->log.fail(VK_ERROR_INITIALIZATION_FAILED, "extent %ux%u: both sides must be at least 1",
                             desc->extent.width, desc->extent.height);
  }
  if (desc->memoryBudget < vitrail::kLeastBudget) {
    return context->log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY, "memoryBudget %llu: tiles need at least 65536 bytes",
                             static_cast<unsigned long long>(desc->memoryBudget));
  }
  const vitrail::TilePlanInfo info = vitrail::planInfo(context, *desc);
  if (info.nodeCapacityLimit == 0) {
    return context->log.fail(VK_ERROR_FORMAT_NOT_SUPPORTED, "nodeFormat %d has no nodes at %u samples",
                             desc->nodeFormat, info.samples);
  }
  std::unique_ptr<VitrailTilePlan_T> made(new (std::nothrow) VitrailTilePlan_T{context, vitrail::TilePlan(info)});
  if (!made) return context->log.fail(VK_ERROR_OUT_OF_HOST_MEMORY, "no memory for a tile plan");
  *plan = made.release();
  return VK_SUCCESS;
}

extern "C" void vitrailDestroyTilePlan(VitrailTilePlan plan) { std::default_delete<VitrailTilePlan_T>()(plan); }

extern "C" void vitrailTilePlanTarget(VitrailTilePlan plan, VitrailTargetDesc* desc) {
  desc->nodeCapacity = plan->plan.nodeCapacity();
  desc->areaPixels = plan->plan.areaPixels();
  desc->memoryBudget = 0;
  desc->overflow = VITRAIL_OVERFLOW_SKIP;
}

extern "C" VkBool32 vitrailNextTile(VitrailTilePlan plan, VkRect2D* tile) {
  vitrail::Rectangle next;
  if (!plan->plan.next(next)) return VK_FALSE;
  *tile = vitrail::toRect(next);
  return VK_TRUE;
}

extern "C" VkResult vitrailFinishTile(VitrailTilePlan plan, const VitrailStats* stats) {
  if (plan->plan.finish(stats->fragmentsRequested, stats->fragmentsMissing, stats->nodeCapacity)) return VK_SUCCESS;
  return plan->context->log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY,
                                 "one pixel has %llu fragments: that takes a memory budget of %llu bytes",
                                 static_cast<unsigned long long>(stats->fragmentsRequested),
                                 static_cast<unsigned long long>(plan->plan.bytesNeeded()));
}

extern "C" void vitrailProjectBounds(uint32_t count, const VitrailBounds* bounds, VkExtent2D extent, VkRect2D* area) {
  *area = vitrail::toRect(vitrail::projectBounds(vitrail::clipBoxes(count, bounds), extent.width, extent.height));
}
