// The smallest host of the library: it draws points, so that a test decides every fragment of every list, over an
// opaque scene whose every sample it decides too, and gives back the picture, the statistics and the words around the
// memory.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <vitrail/vitrail.hpp>

#include "core/node.h"
#include "core/pool.h"
#include "gpu/device.h"
#include "gpu/resources.h"
#include "gpu/submit.h"
#include "gpu/unique.h"
#include "point_pipelines.h"
#include "stage/picture_images.h"

namespace vitrail::tests {

// One fragment: pixel, depth in [0, 1], linear colour, blend mode, the samples that it covers.
struct Point {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  float depth = 0.5F;
  std::array<float, 4> color{};
  std::uint32_t blend = VITRAIL_BLEND_OVER;
  std::uint32_t coverage = 0xff;
  bool stranger = false; // drawn by PointHostDesc::strangersFor
};

using FloatColor = std::array<float, 4>;

struct PointHostDesc {
  std::uint32_t width = 8;
  std::uint32_t height = 8;
  std::uint32_t capacity = 0;
  VitrailNodeFormat nodes = VITRAIL_NODE_STANDARD;
  std::uint32_t samples = 1;
  VitrailDepthOrder depthOrder = VITRAIL_DEPTH_NEAREST_IS_ZERO;
  VitrailResolve resolve = VITRAIL_RESOLVE_COMPUTE;
  VitrailMsaaResolve msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  VkFormat colorFormat = VK_FORMAT_R32G32B32A32_SFLOAT; // results of 16-bit formats are not read back
  std::uint32_t maxLayers = 0;
  VitrailOverflow overflow = VITRAIL_OVERFLOW_APPROXIMATE;
  VitrailLinking linking = VITRAIL_LINKING_FRAGMENT;
  VkDeviceSize memoryBudget = 0; // the pool follows it: every draw updates the target first
  std::uint32_t areaPixels = 0;
  bool postDepthCoverage = true;  // where there are several samples and the device has it
  bool dualSourceBlending = true; // where the device has it
  bool addresses = false;         // the pool is reached by its address
  bool stencilMark = false;
  bool specialized = false; // the collecting shader is, for this target or, if given, for one that differs in these
  std::optional<VitrailNodeFormat> specializedFor;
  std::optional<VitrailOverflow> specializedForOverflow;
  std::optional<VitrailLinking> specializedForLinking;
  // Strangers among the points are drawn by a shader that is specialized for a target that differs in this.
  std::optional<VitrailOverflow> strangersFor;
  bool guarded = false; // the memory is this host's, between guard words
  // The fragments that are taken to have asked for a node before the first point. `guarded` only.
  std::uint32_t requestedBefore = 0;

  FloatColor behind = {0.0F, 0.0F, 0.0F, 1.0F}; // the opaque colour
  std::vector<FloatColor> behindSamples;        // the same sample by sample, if it differs
  // What the image that a per-pixel resolve of several samples writes holds before.
  FloatColor beforeResolve = {};
  std::vector<float> opaqueDepth; // by sample; default: nothing is hidden
};

// The opaque colour at a sample.
FloatColor behindAt(const PointHostDesc& desc, std::uint32_t sample);

struct PointResult {
  std::vector<FloatColor> pixels; // rows top to bottom; the mean of the samples
  VitrailStats stats{};
};

class PointHost {
 public:
  // What the words before and behind the library's memory hold, as long as nobody writes there.
  static constexpr std::uint32_t kGuard = 0xa5000023U; // as a node, of pixel 35
  static constexpr std::uint32_t kGuardWords = 1024;

  static constexpr std::uint32_t kFramesTogether = 2;

  PointHost(tool::Gpu& gpu, const PointHostDesc& desc);

  // Draws the points as one frame and waits for it.
  PointResult draw(std::span<const Point> points);

  // Draws frames, all in one command buffer, so that nothing but the library's own barriers keeps them apart. At most
  // kFramesTogether of them.
  std::vector<PointResult> drawTogether(const std::vector<std::vector<Point>>& frames);

  // Records a frame, gives the target another size, records a second frame, and submits both at once.
  std::array<PointResult, 2> drawAcrossResize(std::span<const Point> first, VkExtent2D extent,
                                              std::span<const Point> second);

  // Draws the opaque scene once and the points over it, area by area, each a frame of its own, as `next` gives them; it
  // is told what became of the last one. Every area draws all points. The result's statistics are the last area's.
  using NextArea = std::function<bool(const VitrailStats* last, VkRect2D& area)>;
  PointResult drawAreas(std::span<const Point> points, const NextArea& next);

  // As draw(), but between collecting and resolving every node moves to another place of the pool: devices that run
  // many fragments at once hand nodes out in any order, others along each list. `guarded`, one sample, `standard` nodes
  // and VITRAIL_OVERFLOW_SKIP only.
  PointResult drawScattered(std::span<const Point> points);

  // Records a frame and never submits it, as hosts do whose swapchain is out of date.
  void drop(std::span<const Point> points);

  // Whether every guard word is as it was.
  [[nodiscard]] bool guardsUntouched();

  // A part of the library's memory, as the last frame left it. `guarded` only.
  [[nodiscard]] std::vector<std::uint32_t> words(StoragePart StorageLayout::*part);

  [[nodiscard]] const Target& target() const { return target_; }
  [[nodiscard]] const Context& context() const { return *context_; }

 private:
  // The images of one frame, and where its picture is read.
  struct Slot {
    VkExtent2D extent{};
    tool::UsedImage color;        // single-sample
    tool::UsedImage multisampled; // where there are several
    tool::UsedImage depth;
    tool::Unique<VkImageView> sampledDepth; // of the depth aspect
    tool::GpuBuffer readback;
  };

  // Points in memory that the device reads.
  struct Vertices {
    std::span<const Point> points;
    tool::GpuBuffer buffer;
  };

  [[nodiscard]] Slot makeSlot() const;
  void makeSlots();
  [[nodiscard]] VitrailViews views();
  [[nodiscard]] VitrailTargetDesc targetDesc();
  void createTarget(VitrailTargetDesc& desc);
  [[nodiscard]] PointPipelinesInfo pipelinesInfo() const;
  [[nodiscard]] PointPipelinesInfo specialized(PointPipelinesInfo info, const VitrailTargetDesc& target) const;
  [[nodiscard]] Vertices upload(std::span<const Point> points) const;
  Slot& slotOf(std::uint64_t frame) { return slots_[frame % kFramesTogether]; }

  void recordOpaque(VkCommandBuffer commands, Slot& slot);
  void recordClear(VkCommandBuffer commands, Slot& slot) const;
  void recordRequests(VkCommandBuffer commands);
  void recordFrame(VkCommandBuffer commands, std::uint64_t frame, Slot& slot, std::uint32_t view, const VkRect2D& area,
                   const Vertices& vertices);
  void recordPoints(VkCommandBuffer commands, Slot& slot, const Vertices& vertices);
  void recordResolve(VkCommandBuffer commands, Slot& slot, std::uint32_t view);
  void recordResolveScope(VkCommandBuffer commands, Slot& slot);
  void scatterNodes();
  static void recordPicture(VkCommandBuffer commands, Slot& slot, bool perSample);
  [[nodiscard]] PointResult read(const Slot& slot, std::uint64_t frame) const;

  [[nodiscard]] bool multisampled() const { return desc_.samples > 1; }
  [[nodiscard]] bool perSample() const {
    return multisampled() && desc_.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  }
  [[nodiscard]] bool hasDepth() const { return depthFormat_ != VK_FORMAT_UNDEFINED; }
  [[nodiscard]] VkRect2D wholeArea() const { return {{0, 0}, {desc_.width, desc_.height}}; }

  tool::Gpu& gpu_;
  PointHostDesc desc_;
  bool postDepthCoverage_ = false;
  VkFormat depthFormat_ = VK_FORMAT_UNDEFINED;
  std::uint64_t frame_ = 0;
  Context* context_ = nullptr;
  std::array<Slot, kFramesTogether> slots_; // of frame n: n % kFramesTogether
  std::vector<Slot> retired_;               // of before a resize
  // What views() points to.
  std::array<VkImageView, kFramesTogether> colorViews_{};
  std::array<VkImageView, kFramesTogether> opaqueViews_{};
  std::array<VkImageView, kFramesTogether> depthViews_{};
  VkDeviceSize guardBytes_ = 0;
  StorageLayout storage_;  // of the memory between the guards
  tool::GpuBuffer memory_; // guards, the library's memory, guards
  tool::GpuBuffer guards_; // a copy of the guards for the host
  Target target_;
  PointPipelines* pipelines_ = nullptr; // shared
  PointPipelines* strangers_ = nullptr; // of strangers; shared
  tool::Submitter submitter_;
};

// The library's context on a device with these features: one for all hosts that want the same, so that its pipelines,
// and the hosts', are made once. They must be dropped before the device is.
Context& sharedContext(tool::Gpu& gpu, std::uint32_t features);
void dropContexts();

} // namespace vitrail::tests
