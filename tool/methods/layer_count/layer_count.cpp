#include "layer_count.h"

#include <algorithm>

#include "../../gpu/accesses.h"
#include "shaders/layer_count.frag.h"

namespace vitrail::tool {

namespace {

SurfacePipelines makeSurfaces(const MethodHost& host, VkDescriptorSetLayout set) {
  return {host.surfaces,
          host.surfaces.scene().transparentDraws(),
          {.set = set, .name = "layer count"},
          [](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
            info.fragmentShader = shaders::layer_count_frag;
            info.depthFormat = PictureImages::depthFormat(false);
          }};
}

} // namespace

LayerCount::LayerCount(const MethodHost& host)
    : gpu_(host.gpu),
      set_(gpu_, {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT}}, "layer count"),
      surfaces_(makeSurfaces(host, set_.layout())) {}

void LayerCount::setTarget(const MethodTarget& target) {
  extent_ = target.extent;
  GpuImageInfo info;
  info.extent = extent_;
  info.format = VK_FORMAT_R32_UINT;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  if (!counts_.ensure(gpu_, info, "layer counts")) return;
  readback_ = GpuBuffer(gpu_, std::uint64_t{extent_.width} * extent_.height * sizeof(std::uint32_t),
                        VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Readback, "layer counts");
  set_.writeImage(0, counts_.get().view(), VK_IMAGE_LAYOUT_GENERAL);
}

void LayerCount::releaseTarget() {
  counts_ = UsedImage();
  readback_ = GpuBuffer();
}

void LayerCount::draw(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  // The last frame's copy read the counts -> they are cleared.
  counts_.cmdClear(commands, {});
  // The clear -> the surfaces add.
  counts_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kFragmentReadWrite);
  PictureImages& images = frame.images();
  cmdBeginScope(commands, images.transparentScope({{0, 0}, images.extent()}));
  frame.drawSurfaces(surfaces_, set_.set());
  vkCmdEndRendering(commands);
  // The surfaces added -> the copy reads.
  counts_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kCopyRead);
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {extent_.width, extent_.height, 1};
  vkCmdCopyImageToBuffer(commands, counts_.get().get(), VK_IMAGE_LAYOUT_GENERAL, readback_.get(), 1, &copy);
  // The copy wrote -> the host reads after the fence.
  cmdMemoryBarrier(commands, kCopyWrite, kHostRead);
  frame.endPass("count");
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
  stats.layersMean = meanLayers(stats.fragmentsRequested, covered);
  stats.totalBytes = readback_.size() * 2;
  return stats;
}

} // namespace vitrail::tool
