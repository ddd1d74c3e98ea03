#include "layer_count.h"

#include <algorithm>

#include "../draw/barrier.h"
#include "shaders/layer_count.frag.h"

namespace vitrail::tool {

LayerCount::LayerCount(Gpu& gpu)
    : gpu_(gpu), set_(gpu, {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT}}, "layer count") {}

SurfaceDrawing LayerCount::surface(std::uint32_t /*features*/) const {
  SurfaceDrawing drawing;
  drawing.fragmentShader = shaders::layer_count_frag;
  return drawing;
}

void LayerCount::setTarget(const MethodTarget& target) {
  if (counts_.get() != VK_NULL_HANDLE) return; // let go of when the size changes
  extent_ = target.extent;
  GpuImageInfo info;
  info.extent = extent_;
  info.format = VK_FORMAT_R32_UINT;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  counts_ = GpuImage(gpu_, info, "layer counts");
  readback_ = GpuBuffer(gpu_, std::uint64_t{extent_.width} * extent_.height * sizeof(std::uint32_t),
                        VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Readback, "layer counts");
  set_.writeImage(0, counts_.view(), VK_IMAGE_LAYOUT_GENERAL);
}

void LayerCount::releaseTarget() {
  counts_ = GpuImage();
  readback_ = GpuBuffer();
}

void LayerCount::cmdBegin(VkCommandBuffer commands, std::uint64_t /*frame*/, const VkRect2D& /*area*/) {
  // The last frame's copy read the counts -> they are cleared; their content is not needed.
  cmdImageBarrier(commands, counts_.get(), counts_.range(), VK_IMAGE_LAYOUT_UNDEFINED,
                  {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_NONE}, VK_IMAGE_LAYOUT_GENERAL,
                  {VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT});
  const VkClearColorValue none{};
  const VkImageSubresourceRange all = counts_.range();
  vkCmdClearColorImage(commands, counts_.get(), VK_IMAGE_LAYOUT_GENERAL, &none, 1, &all);
  // The clear -> the surfaces add.
  cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                   {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT});
}

void LayerCount::cmdCollected(VkCommandBuffer commands) {
  // The surfaces added -> the copy reads.
  cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                   {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {extent_.width, extent_.height, 1};
  vkCmdCopyImageToBuffer(commands, counts_.get(), VK_IMAGE_LAYOUT_GENERAL, readback_.get(), 1, &copy);
  // The copy wrote -> the host reads after the fence.
  cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                   {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

MethodStats LayerCount::stats() const {
  MethodStats stats;
  const auto* counts = static_cast<const std::uint32_t*>(readback_.mapped());
  stats.pixelLayers.assign(counts, counts + std::size_t{extent_.width} * extent_.height);
  std::uint64_t covered = 0;
  for (const std::uint32_t layers : stats.pixelLayers) {
    stats.fragmentsRequested += layers;
    stats.layersMax = std::max(stats.layersMax, layers);
    if (layers > 0) ++covered;
  }
  if (covered > 0) stats.layersMean = static_cast<double>(stats.fragmentsRequested) / static_cast<double>(covered);
  stats.totalBytes = readback_.size() * 2;
  return stats;
}

} // namespace vitrail::tool
