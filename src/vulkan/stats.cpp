// What the GPU reports about a frame: copied out at its end, read by the host later.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>

#include "barrier.h"
#include "dispatch_compute.h"

namespace vitrail {

namespace {

// Of the frame's slot.
void slotBarrier(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, VkPipelineStageFlags destination,
                 VkAccessFlags accesses) {
  const VkBufferMemoryBarrier barrier = bufferBarrier(target.stats.buffer, target.slotOffset(target.frame),
                                                      sizeof(StatsSlot), VK_ACCESS_TRANSFER_WRITE_BIT, accesses);
  target.context->vk.CmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_TRANSFER_BIT, destination, 0, 0, nullptr, 1,
                                        &barrier, 0, nullptr);
}

// Copies the counters to the frame's slot, with what the host knows of the frame, then the tag that says that they are
// there.
void copyStats(VkCommandBuffer commandBuffer, const VitrailTarget_T& target) {
  const Dispatch& vk = target.context->vk;
  const Storage& storage = target.storage;
  const VkDeviceSize slot = target.slotOffset(target.frame);
  // Writers: the resolve (counters) and the clear (the slot's tag). Reader and writer: the copy.
  recordBarrier(
      commandBuffer, target,
      {VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
       VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT},
      {VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT});
  const VkBufferCopy region{storage.offset + storage.layout.control.offset, slot, sizeof(layout::VitrailControl)};
  vk.CmdCopyBuffer(commandBuffer, storage.buffer, target.stats.buffer, 1, &region);
  static_assert(offsetof(StatsSlot, sumsCleared) == offsetof(StatsSlot, nodeCapacity) + sizeof(std::uint32_t));
  const std::array<std::uint32_t, 2> known = {storage.nodeCapacity, storage.sumsAreClear ? target.sumsCleared : 0};
  vk.CmdUpdateBuffer(commandBuffer, target.stats.buffer, slot + offsetof(StatsSlot, nodeCapacity), sizeof(known),
                     known.data());

  // Writers: the copy and the update. Readers: the host, and the order of the tag, which is written after.
  slotBarrier(commandBuffer, target, VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_HOST_BIT,
              VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT);
  const std::uint64_t tag = target.frame + 1;
  vk.CmdUpdateBuffer(commandBuffer, target.stats.buffer, slot + offsetof(StatsSlot, tag), sizeof(tag), &tag);

  // Writer: the tag. Reader: the host.
  slotBarrier(commandBuffer, target, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

// A fragment resolve only reads the sums, several times a pixel where it runs per sample.
void cleanUpSums(VkCommandBuffer commandBuffer, VitrailTarget_T& target) {
  // Reader: the resolve. Writer: the cleaning.
  recordBarrier(commandBuffer, target, {VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0},
                {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT});
  bindTargetSet(commandBuffer, target);
  dispatchIndirect(commandBuffer, target, target.pipelines.clearSums,
                   offsetof(layout::VitrailControl, overflowGroupsX));
  target.storage.sumsAreClear = true;
}

} // namespace

} // namespace vitrail

extern "C" void vitrailCmdEnd(VkCommandBuffer commandBuffer, VitrailTarget target) {
  if (target->pipelines.clearSums != VK_NULL_HANDLE) vitrail::cleanUpSums(commandBuffer, *target);
  vitrail::copyStats(commandBuffer, *target);
}

extern "C" VkResult vitrailReadStats(VitrailTarget target, uint64_t frame, VitrailStats* stats) {
  auto* slot =
      reinterpret_cast<vitrail::StatsSlot*>(static_cast<char*>(target->stats.mapped) + target->slotOffset(frame));
  // The counters are read between two looks at the tag: the GPU may start to write the slot again at any time.
  const std::uint64_t tag = frame + 1;
  const std::atomic_ref<std::uint64_t> written(slot->tag);
  if (tag == 0 || written.load(std::memory_order_acquire) != tag) return VK_NOT_READY;
  const vitrail::layout::VitrailControl control = slot->control;
  const std::uint32_t nodeCapacity = slot->nodeCapacity;
  std::atomic_thread_fence(std::memory_order_acquire);
  if (written.load(std::memory_order_relaxed) != tag) return VK_NOT_READY;
  *stats = {};
  stats->frame = frame;
  stats->nodeCapacity = nodeCapacity;
  const std::uint64_t requested = std::uint64_t{control.wraps} * vitrail::layout::VITRAIL_WRAP_STEP + control.requested;
  stats->fragmentsRequested = requested + control.misfits;
  stats->fragmentsStored = std::min<std::uint64_t>(requested, stats->nodeCapacity) - control.misfitNodes;
  stats->fragmentsMissing = stats->fragmentsRequested - stats->fragmentsStored;
  stats->cutPixels = control.cutPixels;
  stats->approximatePixels = control.approximatePixels;
  stats->exact = stats->fragmentsMissing == 0 && stats->cutPixels == 0 && stats->approximatePixels == 0 ? 1 : 0;
  stats->layersMax = control.layersMax;
  for (const std::uint32_t part : control.coveredPixels) stats->coveredPixels += part;
  return VK_SUCCESS;
}
