#include "point_pipelines.h"

#include <cstddef>

#include "shaders/opaque.frag.h"
#include "shaders/opaque.h"
#include "shaders/opaque.vert.h"
#include "shaders/points.vert.h"
#include "shaders/points_address.frag.h"
#include "shaders/points_cpu.frag.h"
#include "shaders/points_cpu_address.frag.h"
#include "shaders/points_hlsl.frag.h"
#include "shaders/points_narrow.frag.h"
#include "shaders/points_post_depth.frag.h"
#include "shaders/points_post_depth_address.frag.h"
#include "shaders/points_post_depth_cpu.frag.h"
#include "shaders/points_simple.frag.h"

namespace vitrail::tests::vulkan {

namespace {

Owned<VkShaderModule> makeShader(const Device& device, std::span<const std::uint32_t> code) {
  auto info = zeroed<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  info.codeSize = code.size_bytes();
  info.pCode = code.data();
  return make(device, vkCreateShaderModule, vkDestroyShaderModule, info);
}

Owned<VkPipelineLayout> makeLayout(const Device& device, VkDescriptorSetLayout set, std::uint32_t constantBytes) {
  const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, constantBytes};
  auto info = zeroed<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  info.setLayoutCount = set != VK_NULL_HANDLE ? 1 : 0;
  info.pSetLayouts = &set;
  info.pushConstantRangeCount = constantBytes > 0 ? 1 : 0;
  info.pPushConstantRanges = &range;
  return make(device, vkCreatePipelineLayout, vkDestroyPipelineLayout, info);
}

bool hasStencil(VkFormat format) { return format == VK_FORMAT_D32_SFLOAT_S8_UINT; }

// The parts of a pipeline that depend on what it draws.
struct Draws {
  VkPipelineVertexInputStateCreateInfo input;
  VkPipelineInputAssemblyStateCreateInfo assembly;
  VkPipelineDepthStencilStateCreateInfo depth;
  VkPipelineColorBlendAttachmentState blend;
  VkPipelineRenderingCreateInfo rendering;
};

constexpr std::array<VkVertexInputAttributeDescription, 4> kAttributes = {
    VkVertexInputAttributeDescription{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(PointVertex, position)},
    VkVertexInputAttributeDescription{1, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(PointVertex, color)},
    VkVertexInputAttributeDescription{2, 0, VK_FORMAT_R32_UINT, offsetof(PointVertex, blend)},
    VkVertexInputAttributeDescription{3, 0, VK_FORMAT_R32_UINT, offsetof(PointVertex, word)},
};
constexpr VkVertexInputBindingDescription kBinding = {0, sizeof(PointVertex), VK_VERTEX_INPUT_RATE_VERTEX};

Draws commonDraws(const PointPipelinesInfo& info) {
  Draws draws{};
  draws.input = zeroed<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
  draws.assembly =
      zeroed<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
  draws.depth =
      zeroed<VkPipelineDepthStencilStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
  draws.rendering = zeroed<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
  draws.rendering.depthAttachmentFormat = info.depthFormat;
  if (hasStencil(info.depthFormat)) draws.rendering.stencilAttachmentFormat = info.depthFormat;
  draws.depth.depthTestEnable = info.depthFormat != VK_FORMAT_UNDEFINED ? VK_TRUE : VK_FALSE;
  return draws;
}

Draws pointDraws(const PointPipelinesInfo& info) {
  Draws draws = commonDraws(info);
  draws.input.vertexBindingDescriptionCount = 1;
  draws.input.pVertexBindingDescriptions = &kBinding;
  draws.input.vertexAttributeDescriptionCount = kAttributes.size();
  draws.input.pVertexAttributeDescriptions = kAttributes.data();
  draws.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  draws.depth.depthCompareOp = info.nearestIsOne ? VK_COMPARE_OP_GREATER_OR_EQUAL : VK_COMPARE_OP_LESS_OR_EQUAL;
  if (hasStencil(info.depthFormat)) {
    draws.depth.stencilTestEnable = VK_TRUE;
    vitrailVkStencilMark(&draws.depth.front);
    vitrailVkStencilMark(&draws.depth.back);
  }
  return draws;
}

Draws opaqueDraws(const PointPipelinesInfo& info) {
  Draws draws = commonDraws(info);
  draws.assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  draws.depth.depthWriteEnable = VK_TRUE;
  draws.depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
  draws.blend.colorWriteMask =
      VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  draws.rendering.colorAttachmentCount = 1;
  draws.rendering.pColorAttachmentFormats = &info.colorFormat;
  return draws;
}

} // namespace

PointPipelines::PointPipelines(const Device& device, const PointPipelinesInfo& info)
    : device_(device),
      info_(info),
      pointsLayout_(makeLayout(device, info.set, 0)),
      opaqueLayout_(makeLayout(device, VK_NULL_HANDLE, sizeof(OpaqueConstants))) {}

VkPipeline PointPipelines::points(std::uint32_t mask) {
  auto& pipeline = points_[mask];
  if (!pipeline) pipeline = makePipeline(true, mask);
  return pipeline.get();
}

VkPipeline PointPipelines::opaque(std::uint32_t mask) {
  auto& pipeline = opaque_[mask];
  if (!pipeline) pipeline = makePipeline(false, mask);
  return pipeline.get();
}

std::span<const std::uint32_t> PointPipelines::pointsShader() const {
  const bool cpu = info_.shader == ShaderKind::ForCpu;
  if (info_.shader == ShaderKind::Hlsl) return shaders::points_hlsl_frag;
  if (info_.shader == ShaderKind::Narrow) return shaders::points_narrow_frag;
  if (info_.postDepthCoverage && info_.addresses) return shaders::points_post_depth_address_frag;
  if (info_.postDepthCoverage && cpu) return shaders::points_post_depth_cpu_frag;
  if (info_.postDepthCoverage) return shaders::points_post_depth_frag;
  if (info_.addresses && cpu) return shaders::points_cpu_address_frag;
  if (info_.addresses) return shaders::points_address_frag;
  if (cpu) return shaders::points_cpu_frag;
  return shaders::points_simple_frag;
}

Owned<VkPipeline> PointPipelines::makePipeline(bool points, std::uint32_t mask) const {
  const Draws draws = points ? pointDraws(info_) : opaqueDraws(info_);
  const auto vertexShader =
      makeShader(device_, points ? std::span<const std::uint32_t>(shaders::points_vert) : shaders::opaque_vert);
  const auto fragmentShader = makeShader(device_, points ? pointsShader() : shaders::opaque_frag);
  std::array<VkSpecializationMapEntry, kConstants> entries{};
  for (std::uint32_t i = 0; i < entries.size(); ++i) entries[i] = {info_.firstConstant + i, 4 * i, 4};
  const VkSpecializationInfo constants{entries.size(), entries.data(), sizeof(info_.constants), info_.constants.data()};
  std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
  for (auto& stage : stages) {
    stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stage.pName = "main";
  }
  stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  stages[0].module = vertexShader.get();
  stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  stages[1].module = fragmentShader.get();
  if (points && info_.specialized) stages[1].pSpecializationInfo = &constants;

  auto viewports = zeroed<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
  viewports.viewportCount = 1;
  viewports.scissorCount = 1;
  auto raster =
      zeroed<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
  raster.lineWidth = 1.0F;
  auto samples = zeroed<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
  samples.rasterizationSamples = info_.samples;
  samples.pSampleMask = &mask;
  auto blend = zeroed<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
  blend.attachmentCount = draws.rendering.colorAttachmentCount;
  blend.pAttachments = &draws.blend;
  constexpr std::array<VkDynamicState, 2> kDynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  auto dynamic = zeroed<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
  dynamic.dynamicStateCount = kDynamic.size();
  dynamic.pDynamicStates = kDynamic.data();

  auto info = zeroed<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
  info.pNext = &draws.rendering;
  info.stageCount = stages.size();
  info.pStages = stages.data();
  info.pVertexInputState = &draws.input;
  info.pInputAssemblyState = &draws.assembly;
  info.pViewportState = &viewports;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &draws.depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = points ? pointsLayout_.get() : opaqueLayout_.get();
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(device_.get(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "vkCreateGraphicsPipelines");
  return Owned<VkPipeline>(pipeline, {device_.get(), vkDestroyPipeline});
}

} // namespace vitrail::tests::vulkan
