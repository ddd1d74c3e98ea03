#include "nearest_layers.h"

#include <algorithm>

#include "../../gpu/accesses.h"
#include "counts.h"
#include "layer_memory.h"
#include "layers_shared.h"
#include "shaders/layers_resolve.comp.h"
#include "storing_surfaces.h"

namespace vitrail::tool {

namespace {

constexpr VkShaderStageFlags kNearestStages = VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
constexpr std::uint64_t kEntryWords = 2;

} // namespace

NearestLayers::NearestLayers(const MethodHost& host, const MethodOptions& options)
    : gpu_(host.gpu),
      method_(options.name),
      layers_(options.maxLayers > 0 ? options.maxLayers : kLayers),
      set_(gpu_,
           {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kNearestStages},              // control
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kNearestStages},              // entries
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kNearestStages},              // tails
            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}}, // colour, of the resolve
           method_),
      resolve_(gpu_, set_,
               {.shader = shaders::layers_resolve_comp, .name = method_ + " resolve", .constants = {{1, layers_}}}),
      control_(gpu_, sizeof(shaders::LayersControl), method_ + " control") {
  set_.writeBuffer(0, control_.buffer().get(), control_.buffer().size());
}

SurfacePipelines NearestLayers::makeSurfaces(const MethodHost& host, std::span<const std::uint32_t> shader,
                                             const std::string& name) const {
  const SurfaceProgram program{.set = set_.layout(), .constantBytes = sizeof(VkExtent2D), .name = name};
  return makeStoringSurfaces(host, program, shader, {{1, layers_}});
}

void NearestLayers::setTarget(const MethodTarget& target) {
  set_.writeImage(3, target.color, VK_IMAGE_LAYOUT_GENERAL);
  const bool kept = entries_.get() != VK_NULL_HANDLE && target.extent.width == extent_.width &&
                    target.extent.height == extent_.height;
  if (kept) return;
  releaseTarget();
  extent_ = target.extent;
  entries_ = makeLayerMemory(gpu_, extent_, {method_, layers_, kEntryWords * layers_});
  tails_ = makeLayerMemory(gpu_, extent_, {method_, layers_, shaders::LAYERS_TAIL_WORDS});
  set_.writeBuffer(1, entries_.get(), entries_.size());
  set_.writeBuffer(2, tails_.get(), tails_.size());
}

void NearestLayers::releaseTarget() {
  entries_ = GpuBuffer();
  tails_ = GpuBuffer();
}

void NearestLayers::draw(Frame& frame) {
  clear(frame);
  frame.endPass("clear");
  drawSurfaces(frame);
  blend(frame);
  frame.endPass("resolve");
}

void NearestLayers::clear(Frame& frame) const {
  VkCommandBuffer commands = frame.commands();
  // The last frame's resolve read entries and tails -> they are cleared.
  cmdMemoryBarrier(commands, {kComputeRead.stages, VK_ACCESS_2_NONE}, kClear);
  vkCmdFillBuffer(commands, entries_.get(), 0, entries_.size(), shaders::LAYERS_EMPTY);
  vkCmdFillBuffer(commands, tails_.get(), 0, tails_.size(), 0);
  // The clears -> the draws read and write entries and tails.
  cmdMemoryBarrier(commands, kClear, kFragmentReadWrite);
  control_.cmdClear(commands, kComputeReadWrite);
}

void NearestLayers::drawOnce(Frame& frame, const SurfacePipelines& surfaces) const {
  cmdDrawStoring(frame, surfaces, set_.set(), &extent_);
}

void NearestLayers::blend(Frame& frame) const {
  VkCommandBuffer commands = frame.commands();
  // The draws wrote entries and tails -> the resolve reads them.
  cmdMemoryBarrier(commands, kFragmentWrite, kComputeRead);
  frame.images().cmdToComputeResolve(commands);
  resolve_.cmdRun(commands, extent_);
  control_.cmdRead(commands, kComputeWrite);
}

FrameStats NearestLayers::stats() const {
  const PictureCounts counts = pictureCounts(control_.read<shaders::LayersControl>().counts);
  FrameStats stats;
  stats.counted = true;
  stats.resolve = "compute";
  stats.fragmentsRequested = stats.fragmentsStored = counts.fragments; // those of the tails as sums
  stats.approximatePixels = counts.cutPixels;
  stats.layersMax = counts.layersMax;
  stats.complete = stats.approximatePixels == 0;
  stats.layersMean = meanLayers(stats.fragmentsStored, counts.coveredPixels);
  stats.nodesBytes = entries_.size();
  stats.totalBytes = entries_.size() + tails_.size() + control_.bytes();
  return stats;
}

} // namespace vitrail::tool
