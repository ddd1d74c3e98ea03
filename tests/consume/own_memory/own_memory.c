/* A host that brings the target's memory: a part of a buffer whose other parts must stay as they are. */
#include <stdio.h>

#include "view.h"

enum { GUARD = 0x5aa5c33c };

/* Where the target's part lies in the buffer: one alignment, at least, on either side of it. */
typedef struct Part {
  VkDeviceSize offset;
  VkDeviceSize size; /* a multiple of 4 */
  VkDeviceSize total;
} Part;

static Part placePart(const VitrailVkRequirements* needs) {
  const VkDeviceSize guard = needs->alignment > 256 ? needs->alignment : 256;
  Part part = {.offset = guard, .size = (needs->size + 3) / 4 * 4};
  part.total = part.offset + part.size + guard;
  return part;
}

static void checkGuards(const Host* host, const Buffer* copy, const Part* part) {
  void* mapped;
  hostCheck(host, vkMapMemory(host->device, copy->memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  const uint32_t* words = mapped;
  for (VkDeviceSize byte = 0; byte < part->total; byte += 4) {
    if (byte >= part->offset && byte < part->offset + part->size) continue;
    if (words[byte / 4] != GUARD)
      hostFail(host, "byte %llu of the host's buffer was written", (unsigned long long)byte);
  }
}

int main(void) {
  Host host;
  hostOpen(&host, "own_memory", vkGetInstanceProcAddr, VK_API_VERSION_1_3);
  VitrailVkContext context = hostCreateContext(&host);
  VitrailVkTargetDesc desc = {
      .extent = {64, 48}, .colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT, .nodeCapacity = 3 * 64 * 48};
  VitrailVkRequirements needs = {0};
  hostCheck(&host, vitrailVkTargetRequirements(context, &desc, &needs), "vitrailVkTargetRequirements");
  const Part part = placePart(&needs);
  const VkBufferUsageFlags transfers = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  Buffer buffer = hostCreateBuffer(&host, part.total, needs.usage | transfers, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  Buffer copy = hostCreateBuffer(&host, part.total, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                 VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  desc.buffer = buffer.buffer;
  desc.bufferOffset = part.offset;
  desc.bufferSize = needs.size;
  View view = viewCreate(&host, context, &desc);

  VkCommandBuffer commands = hostBegin(&host);
  vkCmdFillBuffer(commands, buffer.buffer, 0, VK_WHOLE_SIZE, GUARD);
  /* Writer: the fill. Writers: the frame. */
  hostMemoryBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                    VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
  viewRecord(commands, &view);
  hostSubmit(&host, commands);
  viewCheck(&host, &view);
  commands = hostBegin(&host);
  /* Writers: the frame, which has been waited for. Reader: the copy. */
  hostMemoryBarrier(commands, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                    VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
  vkCmdCopyBuffer(commands, buffer.buffer, copy.buffer, 1, &(VkBufferCopy){.size = part.total});
  /* Writer: the copy. Reader: this program. */
  hostMemoryBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                    VK_ACCESS_HOST_READ_BIT);
  hostSubmit(&host, commands);
  checkGuards(&host, &copy, &part);
  printf("own_memory: every pixel is right, and nothing beside the target's part was written\n");

  viewDestroy(&host, &view);
  hostDestroyBuffer(&host, &buffer);
  hostDestroyBuffer(&host, &copy);
  vitrailVkDestroyContext(context);
  return hostClose(&host);
}
