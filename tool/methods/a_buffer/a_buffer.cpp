// An A-buffer as linear arrays: Carpenter, "The A-buffer, an antialiased hidden surface method" (SIGGRAPH 1984), whose
// per-pixel lists are here arrays of the right length, as in Lipowski, "Multi-layered framebuffer condensation: the
// l-buffer concept" (ICCVG 2010), and Vasilakos and Fudos, "S-buffer: Sparsity-aware multi-fragment rendering"
// (Eurographics 2012). A first geometry pass counts each pixel's fragments, a prefix sum over the image gives each
// pixel the start of its array, a second geometry pass fills the arrays, and a resolve sorts and blends them. Any
// number of fragments in a pixel.
//
// Cost: two draws of the surfaces, the first of which shades masked surfaces only, with an atomic operation a fragment
// in each; the prefix sum reads and writes each pixel's count about twice; the resolve of n fragments reads them
// n / 16 times. Memory: 8 bytes a fragment, the 12 of the library's standard node without the next pointer, and 8 bytes
// a pixel. A picture that has more fragments than the last one had room for is drawn again. One sample a pixel.
//
// What it gets wrong: nothing, but for the rounding of standard nodes: colours in 8 bits on the sRGB curve, none
// brighter than white. It holds the whole picture's fragments at once, and refuses where the device cannot.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "../../gpu/accesses.h"
#include "../../gpu/counters.h"
#include "../../gpu/descriptors.h"
#include "../../gpu/pixel_pass.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/counts.h"
#include "../shared/fragment_pool.h"
#include "../shared/storing_surfaces.h"
#include "a_buffer_shared.h"
#include "shaders/a_buffer_add.comp.h"
#include "shaders/a_buffer_count.frag.h"
#include "shaders/a_buffer_fill.frag.h"
#include "shaders/a_buffer_resolve.comp.h"
#include "shaders/a_buffer_scan.comp.h"

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kFragmentBytes = 8;
constexpr std::uint32_t kScanned = 2 * shaders::A_BUFFER_SCAN_GROUP;
constexpr VkShaderStageFlags kABufferStages = VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

std::uint32_t scanGroups(std::uint32_t count) { return (count + kScanned - 1) / kScanned; }

// The steps of the prefix sum: over the pixels, then over the sums of each step's work groups, which lie behind.
std::vector<shaders::ABufferScan> scansOf(std::uint32_t pixels) {
  std::vector<shaders::ABufferScan> scans{{pixels, 0, pixels}};
  while (scanGroups(scans.back().count) > 1) {
    const shaders::ABufferScan last = scans.back();
    const std::uint32_t count = scanGroups(last.count);
    scans.push_back({count, last.totals, last.totals + count});
  }
  return scans;
}

SurfacePipelines makeGeometry(const MethodHost& host, VkDescriptorSetLayout set, std::span<const std::uint32_t> shader,
                              const char* name) {
  return makeStoringSurfaces(host, {.set = set, .constantBytes = sizeof(VkExtent2D), .name = name}, shader);
}

class ABuffer final : public Method {
 public:
  explicit ABuffer(const MethodHost& host);

  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  bool finish() override;
  FrameStats stats() const override;

 private:
  void clear(Frame& frame);
  void sumUp(Frame& frame);
  void cmdScan(VkCommandBuffer commands, VkPipeline pipeline, const shaders::ABufferScan& scan);
  void sortAndBlend(Frame& frame);

  Gpu& gpu_;
  SingleSet set_; // of all passes
  SurfacePipelines count_;
  SurfacePipelines fill_;
  Unique<VkPipelineLayout> scanLayout_;
  Unique<VkPipeline> scan_;
  Unique<VkPipeline> add_;
  PixelPass resolve_;
  Counters control_; // shaders::ABufferControl
  FragmentPool fragments_;
  VkExtent2D extent_{};
  GpuBuffer offsets_; // counts at first; the sums of work groups behind them
  GpuBuffer filled_;
  std::uint32_t total_ = 0; // where in offsets_ the sum of all counts is
};

ABuffer::ABuffer(const MethodHost& host)
    : gpu_(host.gpu),
      set_(gpu_,
           {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kABufferStages}, // offsets
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kABufferStages}, // filled
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kABufferStages}, // fragments
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kABufferStages}, // control
            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kABufferStages}}, // colour
           "a-buffer"),
      count_(makeGeometry(host, set_.layout(), shaders::a_buffer_count_frag, "a-buffer count")),
      fill_(makeGeometry(host, set_.layout(), shaders::a_buffer_fill_frag, "a-buffer fill")),
      scanLayout_(makePipelineLayout(gpu_, {set_.layout()}, {VK_SHADER_STAGE_COMPUTE_BIT, sizeof(shaders::ABufferScan)},
                                     "a-buffer scan")),
      scan_(makeComputePipeline(gpu_, scanLayout_.get(), shaders::a_buffer_scan_comp, "a-buffer scan")),
      add_(makeComputePipeline(gpu_, scanLayout_.get(), shaders::a_buffer_add_comp, "a-buffer add")),
      resolve_(gpu_, set_,
               {.shader = shaders::a_buffer_resolve_comp,
                .name = "a-buffer resolve",
                .constantBytes = sizeof(shaders::ABufferResolve)}),
      control_(gpu_, sizeof(shaders::ABufferControl), "a-buffer control"),
      fragments_(gpu_, set_, {.method = "a-buffer", .fragmentBytes = kFragmentBytes, .binding = 2}) {
  set_.writeBuffer(3, control_.buffer().get(), control_.buffer().size());
}

void ABuffer::setTarget(const MethodTarget& target) {
  set_.writeImage(4, target.color, VK_IMAGE_LAYOUT_GENERAL);
  if (offsets_.get() != VK_NULL_HANDLE && fragments_.made()) return; // released where the size changes
  extent_ = target.extent;
  const std::uint64_t pixels = std::uint64_t{extent_.width} * extent_.height;
  const std::uint64_t most = gpu_.properties().limits.maxStorageBufferRange / sizeof(std::uint32_t);
  if (pixels + pixels / 256 + 16 > std::min<std::uint64_t>(most, std::numeric_limits<std::uint32_t>::max())) {
    throw GpuError(
        fmt::format("the method a-buffer counts the fragments of {} pixels at once, and the shaders of {} "
                    "reach fewer: use linked-list, or a smaller --size",
                    pixels, gpu_.properties().deviceName));
  }
  total_ = scansOf(static_cast<std::uint32_t>(pixels)).back().totals;
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  offsets_ = GpuBuffer(gpu_, (total_ + 1) * sizeof(std::uint32_t), kUsage, MemoryKind::Device, "a-buffer offsets");
  filled_ = GpuBuffer(gpu_, pixels * sizeof(std::uint32_t), kUsage, MemoryKind::Device, "a-buffer filled");
  set_.writeBuffer(0, offsets_.get(), offsets_.size());
  set_.writeBuffer(1, filled_.get(), filled_.size());
  fragments_.guess(pixels, target.surfaces);
}

void ABuffer::releaseTarget() {
  for (GpuBuffer* buffer : {&offsets_, &filled_}) *buffer = GpuBuffer();
  fragments_.release();
}

void ABuffer::draw(Frame& frame) {
  clear(frame);
  frame.endStep("clear");
  cmdDrawStoring(frame, count_, set_.set(), &extent_);
  frame.endStep("count");
  sumUp(frame);
  frame.endStep("sum");
  cmdDrawStoring(frame, fill_, set_.set(), &extent_);
  frame.endStep("fill");
  sortAndBlend(frame);
  frame.endPass("resolve");
}

void ABuffer::clear(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  // The last frame's resolve read counts -> they are cleared.
  cmdMemoryBarrier(commands, {kComputeRead.stages, VK_ACCESS_2_NONE}, kClear);
  vkCmdFillBuffer(commands, offsets_.get(), 0, VK_WHOLE_SIZE, 0);
  vkCmdFillBuffer(commands, filled_.get(), 0, VK_WHOLE_SIZE, 0);
  // The clears -> the geometry passes count.
  cmdMemoryBarrier(commands, kClear, kFragmentReadWrite);
  control_.cmdClear(commands, kComputeReadWrite);
}

void ABuffer::cmdScan(VkCommandBuffer commands, VkPipeline pipeline, const shaders::ABufferScan& scan) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  vkCmdPushConstants(commands, scanLayout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(scan), &scan);
  const std::uint32_t all = scanGroups(scan.count);
  const std::uint32_t row = std::min(all, shaders::A_BUFFER_ROW);
  vkCmdDispatch(commands, row, (all + row - 1) / row, 1);
}

// Up: sums within work groups, then of their totals. Down: what comes before each work group.
void ABuffer::sumUp(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  // The first geometry pass counted -> the counts are summed.
  cmdMemoryBarrier(commands, kFragmentWrite, kComputeReadWrite);
  const VkDescriptorSet set = set_.set();
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, scanLayout_.get(), 0, 1, &set, 0, nullptr);
  const std::vector<shaders::ABufferScan> scans = scansOf(extent_.width * extent_.height);
  for (const shaders::ABufferScan& scan : scans) {
    cmdScan(commands, scan_.get(), scan);
    // A step wrote sums -> the next one reads and writes them.
    cmdMemoryBarrier(commands, kComputeWrite, kComputeReadWrite);
  }
  for (std::size_t i = scans.size() - 1; i-- > 0;) {
    cmdScan(commands, add_.get(), scans[i]);
    cmdMemoryBarrier(commands, kComputeWrite, kComputeReadWrite); // so here
  }
  // The sums -> the second geometry pass reads them.
  cmdMemoryBarrier(commands, kComputeWrite, kFragmentRead);
}

void ABuffer::sortAndBlend(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  // The second geometry pass wrote fragments -> the resolve reads them.
  cmdMemoryBarrier(commands, kFragmentWrite, kComputeReadWrite);
  frame.images().cmdToComputeResolve(commands);
  const shaders::ABufferResolve constants{extent_.width, extent_.height, total_};
  resolve_.cmdRun(commands, extent_, &constants);
  control_.cmdRead(commands, kComputeWrite);
}

bool ABuffer::finish() { return fragments_.fits(control_.read<shaders::ABufferControl>().total); }

FrameStats ABuffer::stats() const {
  const PictureCounts counts = pictureCounts(control_.read<shaders::ABufferControl>().counts);
  FrameStats stats;
  stats.counted = true;
  stats.resolve = "compute";
  stats.fragmentsRequested = stats.fragmentsStored = counts.fragments;
  stats.layersMax = counts.layersMax;
  stats.cutPixels = counts.cutPixels;
  stats.complete = stats.cutPixels == 0;
  stats.errorBound = vitrailNodeErrorBound(VITRAIL_NODE_STANDARD, 1, stats.layersMax); // it stores them so
  stats.layersMean = meanLayers(stats.fragmentsStored, counts.coveredPixels);
  stats.nodesBytes = fragments_.bytes();
  stats.headsBytes = offsets_.size() + filled_.size();
  stats.totalBytes = stats.nodesBytes + stats.headsBytes + control_.bytes();
  return stats;
}

} // namespace

std::unique_ptr<Method> makeABuffer(const MethodHost& host, const MethodOptions& /*options*/) {
  return std::make_unique<ABuffer>(host);
}

} // namespace vitrail::tool
