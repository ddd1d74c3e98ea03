#include "point_pipelines.h"

#include <cstddef>

#include "gpu/vk.h"
#include "shaders/opaque.frag.h"
#include "shaders/opaque.h"
#include "shaders/opaque.vert.h"
#include "shaders/points.vert.h"
#include "shaders/points_address.frag.h"
#include "shaders/points_post_depth.frag.h"
#include "shaders/points_post_depth_address.frag.h"
#include "shaders/points_simple.frag.h"

namespace vitrail::tests {

namespace {

using tool::check;
using tool::Unique;
using tool::vkStruct;

Unique<VkShaderModule> makeShader(VkDevice device, std::span<const std::uint32_t> code) {
  auto info = vkStruct<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  info.codeSize = code.size_bytes();
  info.pCode = code.data();
  VkShaderModule shader = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device, &info, nullptr, &shader), "vkCreateShaderModule");
  return {device, shader, vkDestroyShaderModule};
}

Unique<VkPipelineLayout> makeLayout(VkDevice device, VkDescriptorSetLayout set, std::uint32_t constantBytes) {
  const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, constantBytes};
  auto info = vkStruct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  info.setLayoutCount = set != VK_NULL_HANDLE ? 1 : 0;
  info.pSetLayouts = &set;
  info.pushConstantRangeCount = constantBytes > 0 ? 1 : 0;
  info.pPushConstantRanges = &range;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  check(vkCreatePipelineLayout(device, &info, nullptr, &layout), "vkCreatePipelineLayout");
  return {device, layout, vkDestroyPipelineLayout};
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

constexpr std::array<VkVertexInputAttributeDescription, 3> kAttributes = {
    VkVertexInputAttributeDescription{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(PointVertex, position)},
    VkVertexInputAttributeDescription{1, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(PointVertex, color)},
    VkVertexInputAttributeDescription{2, 0, VK_FORMAT_R32_UINT, offsetof(PointVertex, blend)},
};
constexpr VkVertexInputBindingDescription kBinding = {0, sizeof(PointVertex), VK_VERTEX_INPUT_RATE_VERTEX};

Draws commonDraws(const PointPipelinesInfo& info) {
  Draws draws{};
  draws.input =
      vkStruct<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
  draws.assembly =
      vkStruct<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
  draws.depth =
      vkStruct<VkPipelineDepthStencilStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
  draws.rendering = vkStruct<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
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
    vitrailStencilMark(&draws.depth.front);
    vitrailStencilMark(&draws.depth.back);
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

PointPipelines::PointPipelines(tool::Gpu& gpu, const PointPipelinesInfo& info)
    : gpu_(gpu),
      info_(info),
      pointsLayout_(makeLayout(gpu.device(), info.set, 0)),
      opaqueLayout_(makeLayout(gpu.device(), VK_NULL_HANDLE, sizeof(OpaqueConstants))) {}

VkPipeline PointPipelines::points(std::uint32_t mask) {
  if (!points_.contains(mask)) points_[mask] = make(true, mask);
  return points_[mask].get();
}

VkPipeline PointPipelines::opaque(std::uint32_t mask) {
  if (!opaque_.contains(mask)) opaque_[mask] = make(false, mask);
  return opaque_[mask].get();
}

std::span<const std::uint32_t> PointPipelines::pointsShader() const {
  if (info_.postDepthCoverage && info_.addresses) return shaders::points_post_depth_address_frag;
  if (info_.postDepthCoverage) return shaders::points_post_depth_frag;
  if (info_.addresses) return shaders::points_address_frag;
  return shaders::points_simple_frag;
}

tool::Unique<VkPipeline> PointPipelines::make(bool points, std::uint32_t mask) const {
  const Draws draws = points ? pointDraws(info_) : opaqueDraws(info_);
  const auto vertexShader =
      makeShader(gpu_.device(), points ? std::span<const std::uint32_t>(shaders::points_vert) : shaders::opaque_vert);
  const auto fragmentShader = makeShader(gpu_.device(), points ? pointsShader() : shaders::opaque_frag);
  std::array<VkSpecializationMapEntry, 4> entries{};
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

  auto viewports = vkStruct<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
  viewports.viewportCount = 1;
  viewports.scissorCount = 1;
  auto raster =
      vkStruct<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
  raster.lineWidth = 1.0F;
  auto samples =
      vkStruct<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
  samples.rasterizationSamples = info_.samples;
  samples.pSampleMask = &mask;
  auto blend = vkStruct<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
  blend.attachmentCount = draws.rendering.colorAttachmentCount;
  blend.pAttachments = &draws.blend;
  constexpr std::array<VkDynamicState, 2> kDynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  auto dynamic = vkStruct<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
  dynamic.dynamicStateCount = kDynamic.size();
  dynamic.pDynamicStates = kDynamic.data();

  auto info = vkStruct<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
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
  check(vkCreateGraphicsPipelines(gpu_.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "vkCreateGraphicsPipelines");
  return {gpu_.device(), pipeline, vkDestroyPipeline};
}

} // namespace vitrail::tests
