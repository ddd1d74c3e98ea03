// The way of most published samples of per-pixel linked lists, as a baseline for the library's resolve: one thread a
// pixel copies the list into an array, sorts it by insertion, and blends it. All pixels pay for an array that is as
// large as the longest list that is to be right, and what a list has beyond it is dropped: those frames are reported as
// not exact, with the fragments that are missing. A counter that only rises hands out the nodes, which is wrong from
// 2^32 fragments in a frame. One sample a pixel, no tiles.
#include <algorithm>
#include <cstdint>
#include <memory>

#include "../../gpu/accesses.h"
#include "../../gpu/counters.h"
#include "../../gpu/descriptors.h"
#include "../../gpu/pixel_pass.h"
#include "../../gpu/used_image.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/counts.h"
#include "../shared/fragment_pool.h"
#include "../shared/storing_surfaces.h"
#include "insertion_shared.h"
#include "shaders/insertion_collect.frag.h"
#include "shaders/insertion_resolve.comp.h"

namespace vitrail::tool {

namespace {

constexpr VkShaderStageFlags kInsertionStages = VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

class Insertion final : public Method {
 public:
  explicit Insertion(const MethodHost& host);

  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  bool finish() override;
  FrameStats stats() const override;

 private:
  void clear(Frame& frame);
  void collect(Frame& frame);
  void sortAndBlend(Frame& frame);

  Gpu& gpu_;
  SingleSet set_; // of both passes
  SurfacePipelines surfaces_;
  PixelPass resolve_;
  Counters control_; // shaders::InsertionControl
  VkExtent2D extent_{};
  UsedImage heads_;
  FragmentPool nodes_;
};

Insertion::Insertion(const MethodHost& host)
    : gpu_(host.gpu),
      set_(gpu_,
           {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kInsertionStages}, // control
            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kInsertionStages},  // heads
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kInsertionStages}, // nodes
            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kInsertionStages}}, // colour, of the resolve
           "insertion"),
      surfaces_(makeStoringSurfaces(host, {.set = set_.layout(), .name = "insertion collect"},
                                    shaders::insertion_collect_frag)),
      resolve_(gpu_, set_, {.shader = shaders::insertion_resolve_comp, .name = "insertion resolve"}),
      control_(gpu_, sizeof(shaders::InsertionControl), "insertion control"),
      nodes_(gpu_, set_, {.method = "insertion", .fragmentBytes = sizeof(shaders::InsertionNode), .binding = 2}) {
  set_.writeBuffer(0, control_.buffer().get(), control_.buffer().size());
}

void Insertion::setTarget(const MethodTarget& target) {
  GpuImageInfo info;
  info.extent = target.extent;
  info.format = VK_FORMAT_R32_UINT;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  set_.writeImage(3, target.color, VK_IMAGE_LAYOUT_GENERAL);
  const bool resized = heads_.ensure(gpu_, info, "insertion heads");
  if (!resized && nodes_.made()) return;
  extent_ = target.extent;
  set_.writeImage(1, heads_.get().view(), VK_IMAGE_LAYOUT_GENERAL);
  nodes_.guess(std::uint64_t{extent_.width} * extent_.height, target.surfaces);
}

void Insertion::releaseTarget() {
  heads_ = UsedImage();
  nodes_.release();
}

void Insertion::draw(Frame& frame) {
  clear(frame);
  frame.endStep("clear");
  collect(frame);
  frame.endStep("collect");
  sortAndBlend(frame);
  frame.endPass("resolve");
}

void Insertion::clear(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  VkClearColorValue empty{};
  empty.uint32[0] = UINT32_MAX;
  // The last frame's resolve read the heads -> they are cleared.
  heads_.cmdClear(commands, empty);
  // The clears -> the collect pass reads and writes heads and counters.
  heads_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kFragmentReadWrite);
  control_.cmdClear(commands, kFragmentReadWrite);
}

void Insertion::collect(Frame& frame) {
  cmdDrawStoring(frame, surfaces_, set_.set());
  // The collect pass wrote nodes and counters -> the resolve reads them, and counts.
  cmdMemoryBarrier(frame.commands(), kFragmentWrite, kComputeReadWrite);
  // It wrote heads -> the resolve reads them.
  heads_.cmdUse(frame.commands(), VK_IMAGE_LAYOUT_GENERAL, kComputeRead);
}

void Insertion::sortAndBlend(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  frame.images().cmdToComputeResolve(commands);
  resolve_.cmdRun(commands, extent_);
  control_.cmdRead(commands, kComputeWrite);
}

bool Insertion::finish() { return nodes_.fits(control_.read<shaders::InsertionControl>().taken); }

FrameStats Insertion::stats() const {
  const auto control = control_.read<shaders::InsertionControl>();
  const PictureCounts counts = pictureCounts(control.counts);
  const std::uint64_t inLists = std::min<std::uint64_t>(control.taken, nodes_.capacity());
  FrameStats stats;
  stats.counted = true;
  stats.resolve = "compute";
  stats.layersMax = counts.layersMax;
  stats.approximatePixels = counts.cutPixels;
  stats.fragmentsRequested = control.taken;
  stats.fragmentsStored = inLists - counts.fragments;
  stats.fragmentsMissing = stats.fragmentsRequested - stats.fragmentsStored;
  stats.complete = stats.fragmentsMissing == 0;
  stats.errorBound = vitrailNodeErrorBound(VITRAIL_NODE_STANDARD, 1, stats.layersMax); // it stores them so
  stats.layersMean = meanLayers(inLists, counts.coveredPixels);
  stats.nodesBytes = nodes_.bytes();
  stats.headsBytes = std::uint64_t{extent_.width} * extent_.height * sizeof(std::uint32_t);
  stats.totalBytes = stats.nodesBytes + stats.headsBytes + control_.bytes();
  return stats;
}

} // namespace

std::unique_ptr<Method> makeInsertion(const MethodHost& host, const MethodOptions& /*options*/) {
  return std::make_unique<Insertion>(host);
}

} // namespace vitrail::tool
