#include "insertion.h"

#include <algorithm>

#include <fmt/format.h>

#include "../draw/accesses.h"
#include "shaders/insertion_collect.frag.h"
#include "shaders/insertion_resolve.comp.h"

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kNodeBytes = 12;
constexpr std::uint64_t kNodesPerPixel = 4; // the first guess
constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

std::uint32_t groups(std::uint32_t pixels) {
  return (pixels + shaders::INSERTION_GROUP_SIDE - 1) / shaders::INSERTION_GROUP_SIDE;
}

SurfacePipelines makeCollect(const MethodHost& host, VkDescriptorSetLayout set) {
  return {host.surfaces,
          host.surfaces.scene().transparentDraws(),
          {.set = set, .name = "insertion collect"},
          [](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
            info.fragmentShader = shaders::insertion_collect_frag;
            info.depthFormat = PictureImages::depthFormat(false);
          }};
}

} // namespace

Insertion::Insertion(const MethodHost& host)
    : gpu_(host.gpu),
      set_(gpu_,
           {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kStages}, // control
            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kStages},  // heads
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kStages}, // nodes
            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kStages}}, // colour, of the resolve
           "insertion"),
      surfaces_(makeCollect(host, set_.layout())),
      layout_(makePipelineLayout(gpu_, {set_.layout()}, {}, "insertion")),
      resolve_(makeComputePipeline(gpu_, layout_.get(), shaders::insertion_resolve_comp, "insertion resolve")),
      control_(gpu_, sizeof(shaders::InsertionControl), "insertion control") {
  set_.writeBuffer(0, control_.buffer().get(), control_.buffer().size());
}

// What the pool may have: what one shader can reach, one allocation can hold, and the budget.
std::uint64_t Insertion::mostNodes() const {
  const std::uint64_t reach = gpu_.properties().limits.maxStorageBufferRange;
  return std::min({reach, gpu_.maxAllocation(), target_.memoryBudget.value_or(reach)}) / kNodeBytes;
}

void Insertion::makePool(std::uint64_t nodes) {
  nodes_ = GpuBuffer();                          // first: the old pool and the new one need not fit together
  capacity_ = std::max<std::uint64_t>(nodes, 1); // there are no empty buffers
  nodes_ = GpuBuffer(gpu_, capacity_ * kNodeBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryKind::Device,
                     "insertion nodes");
  set_.writeBuffer(2, nodes_.get(), nodes_.size());
}

void Insertion::setTarget(const MethodTarget& target) {
  GpuImageInfo info;
  info.extent = target.extent;
  info.format = VK_FORMAT_R32_UINT;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const bool resized = heads_.ensure(gpu_, info, "insertion heads");
  const bool samePool = !resized && nodes_.get() != VK_NULL_HANDLE && target.nodeCapacity == target_.nodeCapacity &&
                        target.memoryBudget == target_.memoryBudget && target.surfaces == target_.surfaces;
  target_ = target;
  if (resized) set_.writeImage(1, heads_.get().view(), VK_IMAGE_LAYOUT_GENERAL);
  set_.writeImage(3, target.color, VK_IMAGE_LAYOUT_GENERAL);
  if (samePool) return;
  const std::uint64_t pixels = std::uint64_t{target.extent.width} * target.extent.height;
  const std::uint64_t guess = target.surfaces ? std::min(kNodesPerPixel * pixels, mostNodes()) : 0;
  makePool(target.nodeCapacity ? *target.nodeCapacity : guess);
}

void Insertion::releaseTarget() {
  heads_ = UsedImage();
  nodes_ = GpuBuffer();
}

void Insertion::draw(Frame& frame) {
  clear(frame);
  frame.endPass("clear");
  collect(frame);
  frame.endPass("collect");
  sortAndBlend(frame);
  frame.endPass("resolve");
}

void Insertion::clear(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  // The last frame's resolve read the heads -> they are cleared.
  heads_.discard();
  heads_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kClear);
  VkClearColorValue empty{};
  empty.uint32[0] = UINT32_MAX;
  const VkImageSubresourceRange all = heads_.get().range();
  vkCmdClearColorImage(commands, heads_.get().get(), VK_IMAGE_LAYOUT_GENERAL, &empty, 1, &all);
  // The clears -> the collect pass reads and writes heads and counters.
  heads_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kFragmentReadWrite);
  control_.cmdClear(commands, kFragmentReadWrite);
}

void Insertion::collect(Frame& frame) {
  PictureImages& images = frame.images();
  cmdBeginScope(frame.commands(), images.transparentScope({{0, 0}, images.extent()}));
  frame.drawSurfaces(surfaces_, set_.set());
  vkCmdEndRendering(frame.commands());
  // The collect pass wrote nodes and counters -> the resolve reads them, and counts.
  cmdMemoryBarrier(frame.commands(), kFragmentWrite, kComputeReadWrite);
  // It wrote heads -> the resolve reads them.
  heads_.cmdUse(frame.commands(), VK_IMAGE_LAYOUT_GENERAL, kComputeRead);
}

void Insertion::sortAndBlend(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  frame.images().cmdToComputeResolve(commands);
  const VkDescriptorSet set = set_.set();
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, resolve_.get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1, &set, 0, nullptr);
  vkCmdDispatch(commands, groups(target_.extent.width), groups(target_.extent.height), 1);
  control_.cmdRead(commands, kComputeWrite);
}

bool Insertion::finish() {
  const std::uint64_t wanted = control_.read<shaders::InsertionControl>().taken;
  if (wanted <= capacity_ || target_.nodeCapacity) return true;
  if (wanted > mostNodes()) {
    throw GpuError(
        fmt::format("the method insertion holds all {} fragments of the picture at once, and has room for {}: "
                    "use linked-list, or a smaller --size",
                    wanted, mostNodes()));
  }
  makePool(wanted);
  return false;
}

MethodStats Insertion::stats() const {
  const auto control = control_.read<shaders::InsertionControl>();
  std::uint64_t dropped = 0;
  std::uint64_t covered = 0;
  MethodStats stats;
  for (const shaders::InsertionCounts& counts : control.counts) {
    covered += counts.coveredPixels;
    dropped += counts.dropped;
    stats.layersMax = std::max(stats.layersMax, counts.layersMax);
    stats.approximatePixels += counts.cutPixels;
  }
  const std::uint64_t inLists = std::min<std::uint64_t>(control.taken, capacity_);
  stats.fragmentsRequested = control.taken;
  stats.fragmentsStored = inLists - dropped;
  stats.fragmentsMissing = stats.fragmentsRequested - stats.fragmentsStored;
  stats.exact = stats.fragmentsMissing == 0;
  stats.layersMean = covered > 0 ? static_cast<double>(inLists) / static_cast<double>(covered) : 0.0;
  stats.nodesBytes = capacity_ * kNodeBytes;
  stats.headsBytes = std::uint64_t{target_.extent.width} * target_.extent.height * sizeof(std::uint32_t);
  stats.totalBytes = stats.nodesBytes + stats.headsBytes + control_.bytes();
  return stats;
}

} // namespace vitrail::tool
