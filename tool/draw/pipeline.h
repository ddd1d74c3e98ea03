// Shader modules, pipeline layouts and pipelines.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "device.h"
#include "unique.h"

namespace vitrail::tool {

Unique<VkPipelineLayout> makePipelineLayout(Gpu& gpu, const std::vector<VkDescriptorSetLayout>& sets,
                                            std::uint32_t computeConstantBytes, const std::string& name);

// `spirv` is a compute shader with the entry point main.
Unique<VkPipeline> makeComputePipeline(Gpu& gpu, VkPipelineLayout layout, std::span<const std::uint32_t> spirv,
                                       const std::string& name);

// A graphics pipeline without blending. Viewport and scissor are dynamic.
struct GraphicsPipelineInfo {
  VkPipelineLayout layout = VK_NULL_HANDLE;
  std::span<const std::uint32_t> vertexShader;
  std::span<const std::uint32_t> fragmentShader;
  std::uint32_t features = 0;                  // specialization constant 0 of a surface's shaders
  bool surface = false;                        // reads Vertex data; front face and cull mode are dynamic
  VkFormat colorFormat = VK_FORMAT_UNDEFINED;  // undefined: no colour attachment
  VkCompareOp depthTest = VK_COMPARE_OP_NEVER; // NEVER: neither tested nor written
  bool depthWrite = false;
  std::string name;
};

// The depth attachment is D32_SFLOAT.
Unique<VkPipeline> makeGraphicsPipeline(Gpu& gpu, const GraphicsPipelineInfo& info);

// The pipelines of one surface shader, by features, each made when it is first asked for.
class SurfacePipelines {
 public:
  SurfacePipelines(Gpu& gpu, GraphicsPipelineInfo base) : gpu_(gpu), base_(std::move(base)) {}
  VkPipeline get(std::uint32_t features);

 private:
  Gpu& gpu_;
  GraphicsPipelineInfo base_;
  std::map<std::uint32_t, Unique<VkPipeline>> pipelines_;
};

} // namespace vitrail::tool
