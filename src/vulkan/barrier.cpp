#include "barrier.h"

namespace vitrail {

namespace {

constexpr VkAccessFlags kShaderReadWrite = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;

// On all that shaders share.
VkBufferMemoryBarrier storageBarrier(const Storage& storage, VkAccessFlags source, VkAccessFlags destination) {
  return bufferBarrier(storage.buffer, storage.offset, storage.layout.total, source, destination);
}

} // namespace

VkBufferMemoryBarrier bufferBarrier(VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, VkAccessFlags source,
                                    VkAccessFlags destination) {
  VkBufferMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER;
  barrier.srcAccessMask = source;
  barrier.dstAccessMask = destination;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.buffer = buffer;
  barrier.offset = offset;
  barrier.size = size;
  return barrier;
}

void recordBarriers(VkCommandBuffer commandBuffer, VitrailTarget target, VitrailBarrierPoint point) {
  VitrailBarriers barriers{};
  vitrailBarriers(target, point, &barriers);
  target->context->vk.CmdPipelineBarrier(commandBuffer, barriers.source, barriers.destination, 0, 0, nullptr,
                                         barriers.count, barriers.buffers, 0, nullptr);
}

void recordBarrier(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, Step before, Step after) {
  VkMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  barrier.srcAccessMask = before.accesses;
  barrier.dstAccessMask = after.accesses;
  target.context->vk.CmdPipelineBarrier(commandBuffer, before.stages, after.stages, 0, 1, &barrier, 0, nullptr, 0,
                                        nullptr);
}

} // namespace vitrail

extern "C" void vitrailBarriers(VitrailTarget target, VitrailBarrierPoint point, VitrailBarriers* barriers) {
  using namespace vitrail;
  const Storage& storage = target->storage;
  *barriers = {};
  if (point == VITRAIL_BARRIER_BEFORE_CLEAR) {
    // Writers: the previous frame's fragment shaders (lists, sums), its linking and its resolve (counters, lists), its
    // clear and its copy of the counters. Its readers, the resolve with its indirect dispatches and that copy, are
    // waited for too. Writer here: the clear.
    barriers->source = VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    barriers->destination = VK_PIPELINE_STAGE_TRANSFER_BIT;
    barriers->buffers[barriers->count++] = storageBarrier(
        storage, VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    barriers->buffers[barriers->count++] = bufferBarrier(target->stats.buffer, 0, VK_WHOLE_SIZE,
                                                         VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
  } else if (point == VITRAIL_BARRIER_BEFORE_COLLECT) {
    // Writer: the clear. Readers and writers: vitrailCollect() in fragment shaders, linking, and the resolve, which
    // sees the cleared lists of pixels that no fragment reaches. The nodes of the previous frame, written by its
    // fragment shaders, its linking and its resolve, may now be overwritten, and so may its lists of deep pixels.
    barriers->source =
        VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    barriers->destination = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    barriers->buffers[barriers->count++] =
        storageBarrier(storage, VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_SHADER_WRITE_BIT,
                       VK_ACCESS_UNIFORM_READ_BIT | kShaderReadWrite);
  } else {
    // Writer: vitrailCollect() in fragment shaders. Readers: linking, which writes nodes and heads, the resolve, which
    // also sorts long lists in their nodes and adds to the counters, and the command processor, which reads whether the
    // frame overflowed.
    barriers->source = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    barriers->destination = VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                            VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    barriers->buffers[barriers->count++] =
        storageBarrier(storage, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_INDIRECT_COMMAND_READ_BIT | kShaderReadWrite);
  }
}
