// The graphics pipelines of the point host: points that collect, and the opaque scene behind them. Each is made once a
// sample mask, which decides what a draw covers.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <span>

#include <vitrail/vitrail.h>

#include "gpu/device.h"
#include "gpu/unique.h"

namespace vitrail::tests {

struct PointVertex {
  std::array<float, 3> position; // clip space
  std::array<float, 4> color;
  std::uint32_t blend;
};

struct PointPipelinesInfo {
  VkDescriptorSetLayout set = VK_NULL_HANDLE; // of the library
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  VkFormat colorFormat = VK_FORMAT_UNDEFINED;
  VkFormat depthFormat = VK_FORMAT_UNDEFINED; // UNDEFINED: no depth test. With a stencil: points mark it
  bool nearestIsOne = false;
  bool postDepthCoverage = false; // as the points' shader is compiled
  bool addresses = false;
  bool specialized = false; // the points' shader is, by these constants
  std::array<std::uint32_t, 4> constants{};
  std::uint32_t firstConstant = 0;

  auto operator<=>(const PointPipelinesInfo&) const = default;
};

class PointPipelines {
 public:
  PointPipelines(tool::Gpu& gpu, const PointPipelinesInfo& info);

  // Draws PointVertex points; viewport and scissor are dynamic. `mask` has a bit a sample.
  VkPipeline points(std::uint32_t mask);
  [[nodiscard]] VkPipelineLayout pointsLayout() const { return pointsLayout_.get(); }

  // Draws a triangle over everything, with OpaqueConstants, into colour and depth.
  VkPipeline opaque(std::uint32_t mask);
  [[nodiscard]] VkPipelineLayout opaqueLayout() const { return opaqueLayout_.get(); }

 private:
  using ByMask = std::map<std::uint32_t, tool::Unique<VkPipeline>>;

  [[nodiscard]] std::span<const std::uint32_t> pointsShader() const;
  [[nodiscard]] tool::Unique<VkPipeline> make(bool points, std::uint32_t mask) const;

  tool::Gpu& gpu_;
  PointPipelinesInfo info_;
  tool::Unique<VkPipelineLayout> pointsLayout_;
  tool::Unique<VkPipelineLayout> opaqueLayout_;
  ByMask points_;
  ByMask opaque_;
};

} // namespace vitrail::tests
