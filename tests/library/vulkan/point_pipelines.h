// The graphics pipelines of the point host: points that collect, and the opaque scene behind them. Each is made once a
// sample mask, which decides what a draw covers.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <span>

#include <vitrail/vulkan.h>

#include "objects.h"

namespace vitrail::tests::vulkan {

struct PointVertex {
  std::array<float, 3> position; // clip space
  std::array<float, 4> color;
  std::uint32_t blend;
  std::uint32_t word;
};

// Specialization constants of collecting shaders.
inline constexpr std::size_t kConstants = std::size(VitrailVkSpecialization{}.data);

struct PointPipelinesInfo {
  VkDescriptorSetLayout set = VK_NULL_HANDLE; // of the library
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  VkFormat colorFormat = VK_FORMAT_UNDEFINED;
  VkFormat depthFormat = VK_FORMAT_UNDEFINED; // UNDEFINED: no depth test. With a stencil: points mark it
  bool nearestIsOne = false;
  bool postDepthCoverage = false; // as the points' shader is compiled
  bool addresses = false;
  ShaderKind shader = ShaderKind::Usual;
  bool specialized = false; // the points' shader is, by these constants
  std::array<std::uint32_t, kConstants> constants{};
  std::uint32_t firstConstant = 0;

  auto operator<=>(const PointPipelinesInfo&) const = default;
};

class PointPipelines {
 public:
  PointPipelines(const Device& device, const PointPipelinesInfo& info);

  // Draws PointVertex points; viewport and scissor are dynamic. `mask` has a bit a sample.
  VkPipeline points(std::uint32_t mask);
  [[nodiscard]] VkPipelineLayout pointsLayout() const { return pointsLayout_.get(); }

  // Draws a triangle over everything, with OpaqueConstants, into colour and depth.
  VkPipeline opaque(std::uint32_t mask);
  [[nodiscard]] VkPipelineLayout opaqueLayout() const { return opaqueLayout_.get(); }

 private:
  using ByMask = std::map<std::uint32_t, Owned<VkPipeline>>;

  [[nodiscard]] std::span<const std::uint32_t> pointsShader() const;
  [[nodiscard]] Owned<VkPipeline> makePipeline(bool points, std::uint32_t mask) const;

  const Device& device_;
  PointPipelinesInfo info_;
  Owned<VkPipelineLayout> pointsLayout_;
  Owned<VkPipelineLayout> opaqueLayout_;
  ByMask points_;
  ByMask opaque_;
};

} // namespace vitrail::tests::vulkan
