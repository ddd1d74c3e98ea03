// Shader modules, pipeline layouts and pipelines.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "device.h"
#include "unique.h"

namespace vitrail::tool {

// Push constants start at byte 0, for the stages of one kind of pipeline.
struct PushConstants {
  VkShaderStageFlags stages = 0;
  std::uint32_t bytes = 0;
};

Unique<VkPipelineLayout> makePipelineLayout(Gpu& gpu, const std::vector<VkDescriptorSetLayout>& sets,
                                            const PushConstants& constants, const std::string& name);

// Specialization constants, id and value.
using PipelineConstants = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// `spirv` is a compute shader with the entry point main.
Unique<VkPipeline> makeComputePipeline(Gpu& gpu, VkPipelineLayout layout, std::span<const std::uint32_t> spirv,
                                       const std::string& name, const PipelineConstants& constants = {});

// One colour attachment of a pipeline.
struct ColorOutput {
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::optional<VkPipelineColorBlendAttachmentState> blend; // default: colour is replaced
};

// The blending `source * src + destination * dst` in all channels, with one pair of factors for colour and one for
// alpha.
struct BlendFactors {
  VkBlendFactor src = VK_BLEND_FACTOR_ONE;
  VkBlendFactor dst = VK_BLEND_FACTOR_ZERO;
};
VkPipelineColorBlendAttachmentState blendWith(const BlendFactors& color, const BlendFactors& alpha);

// What vertex shaders read of buffers, whose strides are given where they are bound.
struct VertexLayout {
  std::span<const VkVertexInputBindingDescription> bindings;
  std::span<const VkVertexInputAttributeDescription> attributes; // none: they read nothing
};

// A graphics pipeline. Viewport and scissor are dynamic.
struct GraphicsPipelineInfo {
  VkPipelineLayout layout = VK_NULL_HANDLE;
  std::span<const std::uint32_t> vertexShader;
  std::span<const std::uint32_t> fragmentShader;
  PipelineConstants constants; // of both shaders
  VertexLayout vertices;       // with them front face, cull mode and strides are dynamic
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  std::uint32_t sampleMask = UINT32_MAX; // samples that are drawn, one bit each
  bool shadeEverySample = false;         // at the place of each, where the device has GpuFeatures::sampleRateShading
  bool samplesInMiddle = false;          // all are in the middle of the pixel, which takes GpuFeatures::middleSamples
  std::vector<ColorOutput> colors;
  VkFormat depthFormat = VK_FORMAT_UNDEFINED;  // a format with stencil: both are attached
  VkCompareOp depthTest = VK_COMPARE_OP_NEVER; // NEVER: neither tested nor written
  bool depthWrite = false;
  std::optional<VkStencilOpState> stencil; // default: neither tested nor written
  std::string name;
};

Unique<VkPipeline> makeGraphicsPipeline(Gpu& gpu, const GraphicsPipelineInfo& info);

} // namespace vitrail::tool
