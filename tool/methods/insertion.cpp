#include "insertion.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "../draw/barrier.h"
#include "../draw/vk.h"
#include "shaders/insertion_collect.frag.h"
#include "shaders/insertion_resolve.comp.h"

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kNodeBytes = 12;
constexpr std::uint64_t kNodesPerPixel = 4; // the first guess
constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

GpuBuffer makeBuffer(Gpu& gpu, std::uint64_t bytes, MemoryKind kind, const char* name) {
  constexpr VkBufferUsageFlags kUsage =
      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  return {gpu, bytes, kUsage, kind, name};
}

std::uint32_t groups(std::uint32_t pixels) {
  return (pixels + shaders::INSERTION_GROUP_SIDE - 1) / shaders::INSERTION_GROUP_SIDE;
}

} // namespace

Insertion::Insertion(Gpu& gpu)
    : gpu_(gpu),
      set_(gpu,
           {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kStages}, // control
            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kStages},  // heads
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kStages}, // nodes
            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kStages}}, // colour, of the resolve
           "insertion"),
      layout_(makePipelineLayout(gpu, {set_.layout()}, 0, "insertion")),
      resolve_(makeComputePipeline(gpu, layout_.get(), shaders::insertion_resolve_comp, "insertion resolve")),
      control_(makeBuffer(gpu, sizeof(shaders::InsertionControl), MemoryKind::Device, "insertion control")),
      readback_(makeBuffer(gpu, sizeof(shaders::InsertionControl), MemoryKind::Readback, "insertion counts")) {
  set_.writeBuffer(0, control_.get(), control_.size());
}

SurfaceDrawing Insertion::surface(std::uint32_t /*features*/) const {
  SurfaceDrawing drawing;
  drawing.fragmentShader = shaders::insertion_collect_frag;
  return drawing;
}

// What the pool may have: what one shader can reach, one allocation can hold, and the budget.
std::uint64_t Insertion::mostNodes() const {
  const std::uint64_t reach = gpu_.properties().limits.maxStorageBufferRange;
  return std::min({reach, gpu_.maxAllocation(), target_.memoryBudget.value_or(reach)}) / kNodeBytes;
}

void Insertion::makePool(std::uint64_t nodes) {
  nodes_ = GpuBuffer();                          // first: the old pool and the new one need not fit together
  capacity_ = std::max<std::uint64_t>(nodes, 1); // there are no empty buffers
  nodes_ = makeBuffer(gpu_, capacity_ * kNodeBytes, MemoryKind::Device, "insertion nodes");
  set_.writeBuffer(2, nodes_.get(), nodes_.size());
}

void Insertion::setTarget(const MethodTarget& target) {
  const bool sameSize = heads_.get() != VK_NULL_HANDLE && target.extent.width == target_.extent.width &&
                        target.extent.height == target_.extent.height;
  const bool samePool = sameSize && target.nodeCapacity == target_.nodeCapacity &&
                        target.memoryBudget == target_.memoryBudget && target.surfaces == target_.surfaces;
  target_ = target;
  if (!sameSize) {
    GpuImageInfo info;
    info.extent = target.extent;
    info.format = VK_FORMAT_R32_UINT;
    info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    heads_ = GpuImage(gpu_, info, "insertion heads");
    set_.writeImage(1, heads_.view(), VK_IMAGE_LAYOUT_GENERAL);
  }
  set_.writeImage(3, target.color, VK_IMAGE_LAYOUT_GENERAL);
  if (samePool) return;
  const std::uint64_t pixels = std::uint64_t{target.extent.width} * target.extent.height;
  const std::uint64_t guess = target.surfaces ? std::min(kNodesPerPixel * pixels, mostNodes()) : 0;
  makePool(target.nodeCapacity ? *target.nodeCapacity : guess);
}

void Insertion::releaseTarget() {
  heads_ = GpuImage();
  nodes_ = GpuBuffer();
}

void Insertion::cmdBegin(VkCommandBuffer commands, std::uint64_t /*frame*/, const VkRect2D& /*area*/) {
  // The last frame's resolve and copy read the heads and counters -> they are cleared; their content is not needed.
  const Access before{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_NONE};
  const Access clear{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT}; // of image and buffer
  cmdImageBarrier(commands, heads_.get(), heads_.range(), VK_IMAGE_LAYOUT_UNDEFINED, before, VK_IMAGE_LAYOUT_GENERAL,
                  clear);
  VkClearColorValue empty{};
  empty.uint32[0] = UINT32_MAX;
  const VkImageSubresourceRange all = heads_.range();
  vkCmdClearColorImage(commands, heads_.get(), VK_IMAGE_LAYOUT_GENERAL, &empty, 1, &all);
  vkCmdFillBuffer(commands, control_.get(), 0, control_.size(), 0);
  // The clears -> the collect pass reads and writes heads and counters.
  cmdMemoryBarrier(commands, clear,
                   {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT});
}

void Insertion::cmdCollected(VkCommandBuffer commands) {
  // The collect pass wrote heads, nodes and counters -> the resolve reads them, and counts.
  cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                   {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT});
}

void Insertion::cmdResolve(VkCommandBuffer commands) {
  const VkDescriptorSet set = set_.set();
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, resolve_.get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1, &set, 0, nullptr);
  vkCmdDispatch(commands, groups(target_.extent.width), groups(target_.extent.height), 1);
}

void Insertion::cmdEnd(VkCommandBuffer commands) {
  // The resolve counted -> the copy reads.
  cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                   {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
  const VkBufferCopy all{0, 0, control_.size()};
  vkCmdCopyBuffer(commands, control_.get(), readback_.get(), 1, &all);
  // The copy wrote -> the host reads after the fence.
  cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                   {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

bool Insertion::finishArea(std::uint64_t /*frame*/) {
  const std::uint64_t wanted = static_cast<const shaders::InsertionControl*>(readback_.mapped())->taken;
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
  shaders::InsertionControl control{};
  std::memcpy(&control, readback_.mapped(), sizeof(control));
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
  stats.totalBytes = stats.nodesBytes + stats.headsBytes + control_.size() + readback_.size();
  return stats;
}

} // namespace vitrail::tool
