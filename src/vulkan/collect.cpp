// The recording calls round the host's transparent draws: empty lists before, visible and, for a fragment resolve,
// sorted lists after.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>

#include "barrier.h"
#include "dispatch_compute.h"

namespace vitrail {

namespace {

// The whole target where the host names no area, and never more than there are head pointers for.
VkRect2D areaOf(const VitrailTarget_T& target, const VitrailBeginInfo* info) {
  const VkExtent2D extent = target.desc.extent;
  VkRect2D area{{0, 0}, extent};
  if (info != nullptr && info->area.extent.width != 0 && info->area.extent.height != 0) {
    area.offset.x = std::clamp(info->area.offset.x, 0, static_cast<std::int32_t>(extent.width));
    area.offset.y = std::clamp(info->area.offset.y, 0, static_cast<std::int32_t>(extent.height));
    area.extent.width = std::min(info->area.extent.width, extent.width - static_cast<std::uint32_t>(area.offset.x));
    area.extent.height = std::min(info->area.extent.height, extent.height - static_cast<std::uint32_t>(area.offset.y));
  }
  if (area.extent.width == 0 || area.extent.height == 0) return {area.offset, {0, 0}};
  const std::uint32_t areaPixels = target.storage.areaPixels;
  if (std::uint64_t{area.extent.width} * area.extent.height > areaPixels) {
    static_cast<void>(
        target.context->log.fail(VK_ERROR_INITIALIZATION_FAILED,
                                 "an area of %ux%u pixels is begun, the target has areaPixels %u: the rest is left out",
                                 area.extent.width, area.extent.height, areaPixels));
    area.extent.width = std::min(area.extent.width, areaPixels);
    area.extent.height = areaPixels / area.extent.width;
  }
  return area;
}

layout::VitrailParameters parametersOf(const VitrailTarget_T& target) {
  layout::VitrailParameters parameters{};
  parameters.x = static_cast<std::uint32_t>(target.area.offset.x);
  parameters.y = static_cast<std::uint32_t>(target.area.offset.y);
  parameters.width = target.area.extent.width;
  parameters.height = target.area.extent.height;
  parameters.capacity = target.storage.nodeCapacity;
  parameters.format = target.desc.nodeFormat;
  parameters.samples = target.desc.samples;
  parameters.nearestIsOne = target.desc.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? 1 : 0;
  parameters.keepSums = target.keepSums ? 1 : 0;
  parameters.loose = target.desc.linking == VITRAIL_LINKING_COMPUTE ? 1 : 0;
  const bool binds = target.storage.layout.nodes.size <= target.context->limits.storageBufferRange;
  parameters.widthByBinding = binds ? parameters.width : 0;
  parameters.widthByAddress = target.storage.nodesAddress != 0 ? parameters.width : 0;
  parameters.nodesLow = static_cast<std::uint32_t>(target.storage.nodesAddress);
  parameters.nodesHigh = static_cast<std::uint32_t>(target.storage.nodesAddress >> 32U);
  std::array<std::uint32_t, VITRAIL_LAYOUTS> capacities{};
  static_assert(sizeof(capacities) == sizeof(parameters.capacities));
  capacities.at(VITRAIL_LAYOUT(parameters.format, parameters.samples, parameters.keepSums, parameters.loose,
                               parameters.userWords)) = parameters.capacity;
  std::memcpy(parameters.capacities, capacities.data(), sizeof(capacities));
  return parameters;
}

// Whether a frame has run whose sums were cleared as this one's must be.
bool sumsWereCleared(const VitrailTarget_T& target) {
  auto* slots = static_cast<StatsSlot*>(target.stats.mapped);
  return std::any_of(slots, slots + target.desc.framesInFlight, [&](StatsSlot& slot) {
    return std::atomic_ref<std::uint32_t>(slot.sumsCleared).load(std::memory_order_relaxed) == target.sumsCleared;
  });
}

void clearSums(VkCommandBuffer commandBuffer, VitrailTarget_T& target) {
  Storage& storage = target.storage;
  if (!storage.sumsAreClear) ++target.sumsCleared; // new memory, or a frame that was not resolved
  storage.sumsAreClear = false;                    // until this frame has been resolved
  if (sumsWereCleared(target)) return;
  target.context->vk.CmdFillBuffer(commandBuffer, storage.buffer, storage.offset + storage.layout.sums.offset,
                                   storage.layout.sums.size, 0);
}

void clear(VkCommandBuffer commandBuffer, VitrailTarget_T& target) {
  const Dispatch& vk = target.context->vk;
  const Storage& storage = target.storage;
  const auto fill = [&](const StoragePart& part, VkDeviceSize bytes, std::uint32_t value) {
    if (bytes > 0) vk.CmdFillBuffer(commandBuffer, storage.buffer, storage.offset + part.offset, bytes, value);
  };
  const layout::VitrailParameters parameters = parametersOf(target);
  vk.CmdUpdateBuffer(commandBuffer, storage.buffer, storage.offset + storage.layout.parameters.offset,
                     sizeof(parameters), &parameters);
  fill(storage.layout.heads, VkDeviceSize{parameters.width} * parameters.height * sizeof(layout::uint),
       layout::VITRAIL_END);
  fill(storage.layout.control, storage.layout.control.size, 0);
  if (target.keepSums) clearSums(commandBuffer, target);
  vk.CmdFillBuffer(commandBuffer, target.stats.buffer, target.slotOffset(target.frame) + offsetof(StatsSlot, tag),
                   sizeof(StatsSlot::tag), 0); // the slot's old frame is gone
}

// How much the passes behind have to do; with it, nodes that the collecting shader left loose go on their lists.
void prepare(VkCommandBuffer commandBuffer, const VitrailTarget_T& target) {
  if (target.pipelines.buildLists != VK_NULL_HANDLE) {
    dispatchNodes(commandBuffer, target, target.pipelines.buildLists);
  } else {
    dispatchOne(commandBuffer, target, target.pipelines.prepare);
  }
#ifndef VITRAIL_TEST_OMIT_LINKED_BARRIER // the negative control again
  // Writer: the dispatch. Readers: the command processor, and sorting and the resolve, which link nodes anew and add to
  // the counters.
  recordBarrier(commandBuffer, target, {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT},
                {VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                 VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT});
#endif
}

// For a fragment resolve: lists that are longer than it sorts itself are sorted where they lie.
void sortLongLists(VkCommandBuffer commandBuffer, const VitrailTarget_T& target) {
  dispatchIndirect(commandBuffer, target, target.pipelines.sortFind, offsetof(layout::VitrailControl, pixelGroupsX));
  betweenDispatches(commandBuffer, target);
  dispatchIndirect(commandBuffer, target, target.pipelines.sortLong, classGroups(VITRAIL_CLASS_LONG));
  // Writers: the search and the sorting. Reader: the resolve in fragment shaders, which adds to the counters.
  recordBarrier(commandBuffer, target, {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT},
                {VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT});
}

} // namespace

} // namespace vitrail

extern "C" void vitrailCmdBegin(VkCommandBuffer commandBuffer, VitrailTarget target, const VitrailBeginInfo* info) {
  target->frame = info != nullptr ? info->frame : 0;
  target->area = vitrail::areaOf(*target, info);
  vitrail::recordBarriers(commandBuffer, target, VITRAIL_BARRIER_BEFORE_CLEAR);
  vitrail::clear(commandBuffer, *target);
  vitrail::recordBarriers(commandBuffer, target, VITRAIL_BARRIER_BEFORE_COLLECT);
}

extern "C" void vitrailCmdCollected(VkCommandBuffer commandBuffer, VitrailTarget target) {
#ifndef VITRAIL_TEST_OMIT_COLLECTED_BARRIER // the negative control of the tests: they must notice that it is missing
  vitrail::recordBarriers(commandBuffer, target, VITRAIL_BARRIER_COLLECTED);
#endif
  vitrail::bindTargetSet(commandBuffer, *target);
  vitrail::prepare(commandBuffer, *target);
  if (!target->isCompute()) vitrail::sortLongLists(commandBuffer, *target);
}
