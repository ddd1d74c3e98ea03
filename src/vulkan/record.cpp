#include "record.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "convert.h"

namespace vitrail {

namespace {

// ---- Barriers

VkBufferMemoryBarrier bufferBarrier(const VitrailVkTarget_T& target, Resource resource, const Barrier& barrier) {
  VkBufferMemoryBarrier buffer{};
  buffer.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER;
  buffer.srcAccessMask = toVkAccess(barrier.before.accesses);
  buffer.dstAccessMask = toVkAccess(barrier.after.accesses);
  buffer.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  buffer.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  const bool lists = resource == Resource::Lists;
  buffer.buffer = lists ? target.storage.buffer : target.stats.buffer;
  buffer.offset = lists ? target.storage.offset : 0; // of statistics all: hosts ask before the frame has its slot
  buffer.size = lists ? target.storage.layout.total : target.stats.size;
  return buffer;
}

struct VkBarriers {
  VitrailVkBarriers buffers{};
  VkMemoryBarrier memory{}; // of the picture, whose images are the host's
  std::uint32_t memories = 0;
};

VkBarriers toVk(const VitrailVkTarget_T& target, const Barriers& barriers) {
  VkBarriers vk;
  for (std::uint32_t r = 0; r < kResources; ++r) {
    const Barrier& barrier = barriers[r];
    if (barrier.after.stages == 0) continue;
    vk.buffers.source |= toVkStages(barrier.before.stages);
    vk.buffers.destination |= toVkStages(barrier.after.stages);
    if (static_cast<Resource>(r) == Resource::Picture) {
      vk.memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
      vk.memory.srcAccessMask = toVkAccess(barrier.before.accesses);
      vk.memory.dstAccessMask = toVkAccess(barrier.after.accesses);
      vk.memories = 1;
    } else {
      vk.buffers.buffers[vk.buffers.count++] = bufferBarrier(target, static_cast<Resource>(r), barrier);
    }
  }
  return vk;
}

void recordBarriers(VkCommandBuffer commandBuffer, const VitrailVkTarget_T& target, const Barriers& barriers) {
  const VkBarriers vk = toVk(target, barriers);
  if (vk.buffers.source == 0) return;
  target.context->vk.CmdPipelineBarrier(commandBuffer, vk.buffers.source, vk.buffers.destination, 0, vk.memories,
                                        &vk.memory, vk.buffers.count, vk.buffers.buffers, 0, nullptr);
}

// Whether a negative control of the tests leaves the barriers before a call out: they must notice.
bool isLeftOut(Call call) {
#if defined(VITRAIL_TEST_OMIT_COLLECTED_BARRIER)
  return call == Call::Collected;
#elif defined(VITRAIL_TEST_OMIT_RESOLVE_BARRIER)
  return call == Call::Resolve;
#else
  static_cast<void>(call);
  return false;
#endif
}

// ---- Transfers

void clear(VkCommandBuffer commandBuffer, VitrailVkTarget_T& target) {
  const Functions& vk = target.context->vk;
  const Storage& storage = target.storage;
  const auto fill = [&](const StoragePart& part, VkDeviceSize bytes, std::uint32_t value) {
    if (bytes > 0) vk.CmdFillBuffer(commandBuffer, storage.buffer, storage.offset + part.offset, bytes, value);
  };
  const layout::VitrailParameters parameters =
      parametersOf(target.info, storage.needs.nodeCapacity, storage.pool, target.area, target.frames.newest());
  vk.CmdUpdateBuffer(commandBuffer, storage.buffer, storage.offset + storage.layout.parameters.offset,
                     sizeof(parameters), &parameters);
  fill(storage.layout.heads, headBytes(parameters.width * parameters.height), layout::VITRAIL_END);
  fill(storage.layout.control, storage.layout.control.size, 0);
  if (target.info.keepsSums() && target.sums.begin(target.slots())) {
    fill(storage.layout.sums, storage.layout.sums.size, 0);
  }
  vk.CmdFillBuffer(commandBuffer, target.stats.buffer, target.slotOffset() + offsetof(StatsSlot, tag),
                   sizeof(StatsSlot::tag), 0); // the slot's old frame is gone
}

void copyStatistics(VkCommandBuffer commandBuffer, const VitrailVkTarget_T& target) {
  const Functions& vk = target.context->vk;
  const Storage& storage = target.storage;
  const std::array regions = {
      VkBufferCopy{storage.offset + storage.layout.control.offset, target.slotOffset(), sizeof(layout::VitrailControl)},
      VkBufferCopy{storage.offset + storage.layout.parameters.offset + offsetof(layout::VitrailParameters, frame),
                   target.slotOffset() + offsetof(StatsSlot, begunFrame), sizeof(StatsSlot::begunFrame)}};
  vk.CmdCopyBuffer(commandBuffer, storage.buffer, target.stats.buffer, static_cast<std::uint32_t>(regions.size()),
                   regions.data());
  const FrameFacts facts{storage.needs.nodeCapacity, target.order.misused() ? 1U : 0U, target.sums.fact()};
  vk.CmdUpdateBuffer(commandBuffer, target.stats.buffer, target.slotOffset() + offsetof(StatsSlot, facts),
                     sizeof(facts), &facts);
}

void finishStatistics(VkCommandBuffer commandBuffer, const VitrailVkTarget_T& target) {
  const std::uint64_t tag = target.frames.newest() + 1;
  target.context->vk.CmdUpdateBuffer(commandBuffer, target.stats.buffer, target.slotOffset() + offsetof(StatsSlot, tag),
                                     sizeof(tag), &tag);
}

void beginCopy(VkCommandBuffer commandBuffer, const VitrailVkTarget_T& target, const VitrailRect& area) {
  layout::VitrailCopyHeader header{};
  header.capacity = target.info.copyLayers;
  header.x = area.x;
  header.y = area.y;
  header.width = area.width;
  header.height = area.height;
  const Storage& storage = target.storage;
  target.context->vk.CmdUpdateBuffer(commandBuffer, storage.buffer, storage.offset + storage.layout.copy.offset,
                                     sizeof(header), &header);
}

void finishCopy(VkCommandBuffer commandBuffer, const VitrailVkTarget_T& target, const CallInfo& info) {
  const Storage& storage = target.storage;
  const std::uint64_t pixels = std::uint64_t{info.copied.width} * info.copied.height;
  const VkBufferCopy region{storage.offset + storage.layout.copy.offset, info.copyOffset,
                            copyBytes(pixels, target.info.copyLayers)};
  target.context->vk.CmdCopyBuffer(commandBuffer, storage.buffer, info.copyBuffer, 1, &region);
}

// ---- Shaders

void bindSets(VkCommandBuffer commandBuffer, const VitrailVkTarget_T& target, const Pass& pass, std::uint32_t view) {
  const Storage& storage = target.storage;
  const bool draws = pass.action != Action::Dispatch;
  const bool images = pass.call == Call::Resolve && view < storage.viewCount;
  const std::array<VkDescriptorSet, 2> sets = {storage.set, images ? storage.viewSets[view] : VK_NULL_HANDLE};
  target.context->vk.CmdBindDescriptorSets(commandBuffer,
                                           draws ? VK_PIPELINE_BIND_POINT_GRAPHICS : VK_PIPELINE_BIND_POINT_COMPUTE,
                                           target.context->resolveLayout, 0, images ? 2 : 1, sets.data(), 0, nullptr);
}

std::uint32_t groupsFor(std::uint32_t pixels) { return (pixels + kGroupSide - 1) / kGroupSide; }

void dispatch(VkCommandBuffer commandBuffer, const VitrailVkTarget_T& target, const Pass& pass, VkPipeline pipeline,
              const CallInfo& info) {
  const Functions& vk = target.context->vk;
  const Storage& storage = target.storage;
  vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  switch (pass.extent) {
    case Extent::None:
      break;
    case Extent::One:
      vk.CmdDispatch(commandBuffer, 1, 1, 1);
      break;
    case Extent::Nodes:
      vk.CmdDispatch(commandBuffer, nodeGroups(storage.needs.nodeCapacity), 1, 1);
      break;
    case Extent::Heads:
      vk.CmdDispatch(commandBuffer, nodeGroups(target.area.width * target.area.height), 1, 1);
      break;
    case Extent::Copied:
      vk.CmdDispatch(commandBuffer, groupsFor(info.copied.width), groupsFor(info.copied.height), 1);
      break;
    case Extent::Indirect:
      vk.CmdDispatchIndirect(commandBuffer, storage.buffer,
                             storage.offset + storage.layout.control.offset + pass.arguments);
      break;
  }
}

void draw(VkCommandBuffer commandBuffer, const VitrailVkTarget_T& target, const Pass& pass, VkPipeline pipeline) {
  const Functions& vk = target.context->vk;
  const Storage& storage = target.storage;
  const VkRect2D area = vitrail::toVk(target.area);
  const VkViewport viewport{static_cast<float>(area.offset.x),
                            static_cast<float>(area.offset.y),
                            static_cast<float>(area.extent.width),
                            static_cast<float>(area.extent.height),
                            0.0F,
                            1.0F};
  vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  vk.CmdSetViewport(commandBuffer, 0, 1, &viewport);
  vk.CmdSetScissor(commandBuffer, 0, 1, &area);
  vk.CmdDrawIndirect(commandBuffer, storage.buffer, storage.offset + storage.layout.control.offset + pass.arguments, 1,
                     0);
}

void recordPass(VkCommandBuffer commandBuffer, VitrailVkTarget_T& target, const Pass& pass, VkPipeline pipeline,
                const CallInfo& info) {
  switch (pass.action) {
    case Action::Clear:
      return clear(commandBuffer, target);
    case Action::Dispatch:
      bindSets(commandBuffer, target, pass, info.view);
      dispatch(commandBuffer, target, pass, pipeline, info);
      break;
    case Action::Draw:
    case Action::DrawPlain:
      bindSets(commandBuffer, target, pass, info.view);
      draw(commandBuffer, target, pass, pipeline);
      break;
    case Action::BeginCopy:
      return beginCopy(commandBuffer, target, info.copied);
    case Action::FinishCopy:
      return finishCopy(commandBuffer, target, info);
    case Action::CopyStatistics:
      return copyStatistics(commandBuffer, target);
    case Action::FinishStatistics:
      return finishStatistics(commandBuffer, target);
    case Action::HostDraws:
    case Action::HostReads:
      break;
  }
}

} // namespace

void recordCall(VkCommandBuffer commandBuffer, VitrailVkTarget_T& target, Call call, const CallInfo& info) {
  for (std::size_t i = 0; i < target.plan.passes().size(); ++i) {
    const Pass& pass = target.plan.passes()[i];
    if (pass.call != call) continue;
    recordBarriers(commandBuffer, target, pass.before);
    recordPass(commandBuffer, target, pass, target.pipelines[i], info);
  }
}

void recordBoundary(VkCommandBuffer commandBuffer, const VitrailVkTarget_T& target, Call call) {
  if (!isLeftOut(call)) recordBarriers(commandBuffer, target, target.plan.beforeCall(call));
}

void boundaryOf(const VitrailVkTarget_T& target, Call call, VitrailVkBarriers& barriers) {
  void* next = barriers.next;
  barriers = toVk(target, target.plan.beforeCall(call)).buffers;
  barriers.next = next;
}

} // namespace vitrail
