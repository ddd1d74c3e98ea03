// Shader modules, pipeline layouts and pipelines.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "device.h"
#include "unique.h"

namespace vitrail::tool {

Unique<VkPipelineLayout> makePipelineLayout(Gpu& gpu, const std::vector<VkDescriptorSetLayout>& sets,
                                            std::uint32_t computeConstantBytes, const std::string& name);

// `spirv` is a compute shader with the entry point main.
Unique<VkPipeline> makeComputePipeline(Gpu& gpu, VkPipelineLayout layout, std::span<const std::uint32_t> spirv,
                                       const std::string& name);

// A graphics pipeline. Viewport and scissor are dynamic.
struct GraphicsPipelineInfo {
  VkPipelineLayout layout = VK_NULL_HANDLE;
  std::span<const std::uint32_t> vertexShader;
  std::span<const std::uint32_t> fragmentShader;
  // Specialization constants of both shaders, id and value.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> constants;
  bool surface = false; // reads Vertex data; front face and cull mode are dynamic
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  VkFormat colorFormat = VK_FORMAT_UNDEFINED;               // undefined: no colour attachment
  std::optional<VkPipelineColorBlendAttachmentState> blend; // default: colour is replaced
  VkFormat depthFormat = VK_FORMAT_UNDEFINED;               // a format with stencil: both are attached
  VkCompareOp depthTest = VK_COMPARE_OP_NEVER;              // NEVER: neither tested nor written
  bool depthWrite = false;
  std::optional<VkStencilOpState> stencil; // default: neither tested nor written
  std::string name;
};

Unique<VkPipeline> makeGraphicsPipeline(Gpu& gpu, const GraphicsPipelineInfo& info);

// The pipelines that surfaces are drawn with, one for each set of features (shaders/shared.h), made when it is first
// asked for.
class SurfacePipelines {
 public:
  // `describe` fills in what the pipeline of some features is; the features themselves become constant 0.
  using Describe = std::function<GraphicsPipelineInfo(std::uint32_t features)>;

  SurfacePipelines(Gpu& gpu, Describe describe) : gpu_(gpu), describe_(std::move(describe)) {}
  VkPipeline get(std::uint32_t features);

 private:
  Gpu& gpu_;
  Describe describe_;
  std::map<std::uint32_t, Unique<VkPipeline>> pipelines_;
};

} // namespace vitrail::tool
