#include "encode_image.h"

#include "../gpu/accesses.h"
#include "../gpu/pipeline.h"
#include "encode_shared.h"
#include "shaders/encode_image.comp.h"

namespace vitrail::tool {

namespace {

SingleSet makeSet(Gpu& gpu) {
  return {gpu,
          {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
           {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}},
          "encode to an image"};
}

} // namespace

EncodeImagePass::EncodeImagePass(Gpu& gpu)
    : gpu_(gpu),
      anySet_(makeSet(gpu)),
      layout_(makePipelineLayout(gpu, {anySet_.layout()}, {VK_SHADER_STAGE_COMPUTE_BIT, sizeof(EncodeBand)},
                                 "encode to an image")),
      pipeline_(makeComputePipeline(gpu, layout_.get(), shaders::encode_image_comp, "encode to an image")) {}

std::shared_ptr<EncodeImagePass::Output> EncodeImagePass::makeOutput(const GpuImage& color) const {
  GpuImageInfo info;
  info.extent = color.info().extent;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  auto output = std::make_shared<Output>(Output{GpuImage(gpu_, info, "encoded picture"), makeSet(gpu_)});
  output->set.writeImage(0, color.view(), VK_IMAGE_LAYOUT_GENERAL);
  output->set.writeImage(1, output->image.view(), VK_IMAGE_LAYOUT_GENERAL);
  return output;
}

void EncodeImagePass::cmdEncode(VkCommandBuffer commands, const Output& output, VkExtent2D part,
                                VkBuffer pixels) const {
  const GpuImage& image = output.image;
  // Who sampled it, whom the host has waited for -> the encoding writes it.
  cmdImageBarrier(commands, image.get(), image.range(), VK_IMAGE_LAYOUT_UNDEFINED, {kFragmentSample.stages, 0},
                  VK_IMAGE_LAYOUT_GENERAL, kComputeWrite);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
  const VkDescriptorSet set = output.set.set();
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1, &set, 0, nullptr);
  const EncodeBand band{part.width, part.height, 0, part.height};
  vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(band), &band);
  vkCmdDispatch(commands, encodeGroups(part.width), encodeGroups(part.height), 1);
  VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL;
  Access written = kComputeWrite;
  if (pixels != VK_NULL_HANDLE) {
    // The encoding writes it -> it is copied.
    cmdImageBarrier(commands, image.get(), image.range(), layout, written, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                    kCopyRead);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {part.width, part.height, 1};
    vkCmdCopyImageToBuffer(commands, image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels, 1, &copy);
    // The copy -> the host reads it after the fence.
    cmdMemoryBarrier(commands, kCopyWrite, kHostRead);
    layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    written = {kCopyRead.stages, 0};
  }
  // The encoding writes it, or the copy reads it -> windows sample it.
  cmdImageBarrier(commands, image.get(), image.range(), layout, written, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                  kFragmentSample);
}

} // namespace vitrail::tool
