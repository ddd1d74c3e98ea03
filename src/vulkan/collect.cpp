// The recording calls round the host's transparent draws: empty lists before, visible lists after.
#include <cstddef>

#include "barrier.h"
#include "core/pool.h"

namespace vitrail {

namespace {

constexpr VkAccessFlags kShaderReadWrite = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;

VkBufferMemoryBarrier nodesBarrier(const VitrailTarget_T& target, VkAccessFlags source, VkAccessFlags destination) {
  return bufferBarrier(target.nodeBuffer, target.nodeOffset, nodePoolBytes(target.capacity), source, destination);
}

} // namespace

} // namespace vitrail

extern "C" void vitrailCmdBegin(VkCommandBuffer commandBuffer, VitrailTarget target, const VitrailBeginInfo* info) {
  using namespace vitrail;
  target->frame = info != nullptr ? info->frame : 0;
  const Dispatch& vk = target->context->vk;

  // Writers: the previous frame's fragment shaders (lists), its resolve (counters), its clear and its copy of the
  // counters (transfer). Its readers, the resolve with its indirect dispatch and that copy, are waited for too. Writer
  // here: the clear.
  const std::array<VkBufferMemoryBarrier, 3> beforeClear = {
      bufferBarrier(target->heads, VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                    VK_ACCESS_TRANSFER_WRITE_BIT),
      bufferBarrier(target->control, VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                    VK_ACCESS_TRANSFER_WRITE_BIT),
      bufferBarrier(target->stats, VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_TRANSFER_WRITE_BIT),
  };
  recordBarriers(commandBuffer, *target,
                 VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                     VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                 VK_PIPELINE_STAGE_TRANSFER_BIT, beforeClear);

  vk.CmdFillBuffer(commandBuffer, target->heads.buffer, 0, VK_WHOLE_SIZE, layout::VITRAIL_END);
  vk.CmdFillBuffer(commandBuffer, target->control.buffer, 0, VK_WHOLE_SIZE, 0);
  vk.CmdFillBuffer(commandBuffer, target->stats.buffer, target->slotOffset(target->frame) + offsetof(StatsSlot, tag),
                   sizeof(StatsSlot::tag), 0); // the slot's old frame is gone

  // Writer: the clear. Readers and writers: vitrailCollect() in fragment shaders, and the resolve, which sees the
  // cleared lists of pixels that no fragment reaches. The nodes of the previous frame, written by its fragment shaders
  // and its resolve, may now be overwritten, and so may its list of long lists.
  const std::array<VkBufferMemoryBarrier, 4> beforeCollect = {
      bufferBarrier(target->heads, VK_ACCESS_TRANSFER_WRITE_BIT, kShaderReadWrite),
      bufferBarrier(target->control, VK_ACCESS_TRANSFER_WRITE_BIT, kShaderReadWrite),
      nodesBarrier(*target, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_SHADER_WRITE_BIT),
      bufferBarrier(target->longLists, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_SHADER_WRITE_BIT),
  };
  recordBarriers(
      commandBuffer, *target,
      VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
      VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, beforeCollect);
}

extern "C" void vitrailCmdCollected(VkCommandBuffer commandBuffer, VitrailTarget target) {
  using namespace vitrail;
#ifdef VITRAIL_TEST_OMIT_COLLECTED_BARRIER
  // The negative control of the tests: they must notice that this build leaves the barrier out.
  static_cast<void>(commandBuffer);
  static_cast<void>(target);
#else
  // Writer: vitrailCollect() in fragment shaders. Reader: the resolve, which also sorts long lists in their nodes and
  // adds to the counters.
  const std::array<VkBufferMemoryBarrier, 3> barriers = {
      bufferBarrier(target->heads, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_SHADER_READ_BIT),
      bufferBarrier(target->control, VK_ACCESS_SHADER_WRITE_BIT, kShaderReadWrite),
      nodesBarrier(*target, VK_ACCESS_SHADER_WRITE_BIT, kShaderReadWrite),
  };
  recordBarriers(commandBuffer, *target, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                 barriers);
#endif
}
