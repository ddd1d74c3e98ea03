#include "counters.h"

#include "accesses.h"

namespace vitrail::tool {

Counters::Counters(Gpu& gpu, std::uint64_t bytes, const std::string& name, VkBufferUsageFlags usage)
    : buffer_(gpu, bytes,
              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                  usage,
              MemoryKind::Device, name),
      readback_(gpu, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Readback, name + " readback") {}

void Counters::cmdClear(VkCommandBuffer commands, const Access& user) const {
  // The last copy read -> they are cleared.
  cmdMemoryBarrier(commands, {kCopyRead.stages, VK_ACCESS_2_NONE}, kClear);
  vkCmdFillBuffer(commands, buffer_.get(), 0, buffer_.size(), 0);
  // The clear wrote -> the user reads and writes.
  cmdMemoryBarrier(commands, kClear, user);
}

void Counters::cmdRead(VkCommandBuffer commands, const Access& writer) const {
  // The shaders wrote -> the copy reads.
  cmdMemoryBarrier(commands, writer, kCopyRead);
  const VkBufferCopy all{0, 0, buffer_.size()};
  vkCmdCopyBuffer(commands, buffer_.get(), readback_.get(), 1, &all);
  // The copy wrote -> the host reads after the fence.
  cmdMemoryBarrier(commands, kCopyWrite, kHostRead);
}

} // namespace vitrail::tool
