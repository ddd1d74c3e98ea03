// Counts the transparent fragments of every pixel that opaque surfaces do not hide: the depth complexity, and what
// linked-list stores with hdr nodes. No method to draw with: its picture is the opaque scene, and the counts are
// FrameStats::pixelLayers. Costs one atomic addition a fragment and four bytes a pixel. One sample a pixel.
#include <algorithm>
#include <memory>

#include "../../gpu/accesses.h"
#include "../../gpu/descriptors.h"
#include "../../gpu/used_image.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/storing_surfaces.h"
#include "shaders/layer_count.frag.h"

namespace vitrail::tool {

namespace {

class LayerCount final : public Method {
 public:
  explicit LayerCount(const MethodHost& host);

  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  FrameStats stats() const override;

 private:
  Gpu& gpu_;
  SingleSet set_;
  SurfacePipelines surfaces_;
  VkExtent2D extent_{};
  UsedImage counts_;
  GpuBuffer readback_; // a copy of them
};

LayerCount::LayerCount(const MethodHost& host)
    : gpu_(host.gpu),
      set_(gpu_, {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT}}, "layer count"),
      surfaces_(makeStoringSurfaces(host, {.set = set_.layout(), .name = "layer count"}, shaders::layer_count_frag)) {}

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
  cmdDrawStoring(frame, surfaces_, set_.set());
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

FrameStats LayerCount::stats() const {
  FrameStats stats;
  stats.counted = true;
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

} // namespace

std::unique_ptr<Method> makeLayerCount(const MethodHost& host, const MethodOptions& /*options*/) {
  return std::make_unique<LayerCount>(host);
}

} // namespace vitrail::tool
