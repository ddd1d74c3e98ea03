// The smallest host of the library: it draws points, so that a test decides every fragment of every list, and gives
// back the picture, the statistics and the words around the node pool.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <vitrail/vitrail.hpp>

#include "core/node.h"
#include "draw/device.h"
#include "draw/resources.h"
#include "draw/submit.h"
#include "draw/unique.h"

namespace vitrail::tests {

// One fragment: pixel, depth in [0, 1], linear colour with straight alpha.
struct Point {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  float depth = 0.5F;
  std::array<float, 4> color{};
};

struct PointHostDesc {
  std::uint32_t width = 8;
  std::uint32_t height = 8;
  std::uint32_t capacity = 0;
  VitrailDepthOrder depthOrder = VITRAIL_DEPTH_NEAREST_IS_ZERO;
  VkFormat colorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;   // results of 16-bit formats are not read back
  std::array<float, 4> behind = {0.0F, 0.0F, 0.0F, 1.0F}; // what the colour image holds before the resolve
};

struct PointResult {
  std::vector<std::array<float, 4>> pixels; // rows top to bottom
  VitrailStats stats{};
};

class PointHost {
 public:
  // What the words before and behind the pool hold, as long as nobody writes there.
  static constexpr std::uint32_t kGuard = 0xa5c35a3cU;
  static constexpr std::uint32_t kGuardWords = 1024;

  static constexpr std::uint32_t kColorImages = 2;

  // Creates the target with a node buffer of the host's own, with guard words on both sides.
  PointHost(tool::Gpu& gpu, const PointHostDesc& desc);

  // Draws the points as one frame and waits for it.
  PointResult draw(std::span<const Point> points);

  // Draws frames into the colour images in turn, all in one command buffer, so that nothing but the library's own
  // barriers keeps them apart. At most kColorImages of them.
  std::vector<PointResult> drawTogether(const std::vector<std::vector<Point>>& frames);

  // Whether every guard word is as it was.
  [[nodiscard]] bool guardsUntouched() const;

  [[nodiscard]] const Target& target() const { return target_; }

 private:
  void createTarget(VitrailContextDesc contextDesc);
  void createPipeline();
  void record(VkCommandBuffer commands, std::uint64_t frame, VkBuffer vertices, std::uint32_t count) const;
  void recordPicture(VkCommandBuffer commands, std::uint32_t image) const;
  PointResult read(std::uint64_t frame) const;
  void recordDraw(VkCommandBuffer commands, VkBuffer vertices, std::uint32_t count) const;

  tool::Gpu& gpu_;
  PointHostDesc desc_;
  std::uint64_t frame_ = 0;
  VkDeviceSize guardBytes_ = 0;
  std::array<tool::GpuImage, kColorImages> color_;     // of frame n: n % kColorImages
  tool::GpuBuffer nodes_;                              // guards, pool, guards; in memory that the host can read
  std::array<tool::GpuBuffer, kColorImages> readback_; // of the colour images
  Context context_;
  Target target_;
  tool::Unique<VkPipelineLayout> layout_;
  tool::Unique<VkPipeline> pipeline_;
  tool::Submitter submitter_;
};

} // namespace vitrail::tests
