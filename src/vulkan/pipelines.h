// The resolve's pipelines: compute ones, which the targets of a context share, and graphics ones, which fit one
// target's rendering scope.
#pragma once

#include <compare>
#include <cstdint>

#include <vulkan/vulkan_core.h>

#include "kernels/kernels.h"
#include "vitrail/vulkan.h"

namespace vitrail {

// The specialization constants of src/kernels/target.glsl, in the order of their ids.
struct Specialization {
  std::uint32_t format = 0;
  std::uint32_t samples = 1;
  VkBool32 nearestIsOne = VK_FALSE;
  std::uint32_t maxLayers = 0;
  VkBool32 testDepth = VK_FALSE;
  std::uint32_t group = 4; // of Kernel::ResolveGroup: invocations that share a list

  auto operator<=>(const Specialization&) const = default;
};

// Which compute pipeline.
struct ComputeKey {
  Kernel kernel = Kernel::Resolve;
  ColorImage color = ColorImage::Rgba16f;
  bool multisampled = false;
  bool byAddress = false;
  bool networks = true;
  Specialization constants;

  auto operator<=>(const ComputeKey&) const = default;
};

// The context's pipeline of that key, which is made where it is missing. Logs its errors.
VkResult computePipeline(VitrailVkContext_T& context, const ComputeKey& key, VkPipeline* pipeline);

// Which graphics pipeline.
struct FragmentInfo {
  FragmentResolve resolve = FragmentResolve::Single;
  bool byAddress = false;
  bool networks = true;
  Specialization constants;
  VkSampleCountFlagBits scopeSamples = VK_SAMPLE_COUNT_1_BIT;
  VkFormat colorFormat = VK_FORMAT_UNDEFINED;
  VitrailVkScope scope{};
};

// Makes a graphics pipeline, which the caller destroys. Logs its errors.
VkResult createFragmentPipeline(const VitrailVkContext_T& context, const FragmentInfo& info, VkPipeline* pipeline);

} // namespace vitrail
