#include "pipeline.h"

#include <array>

#include <fmt/format.h>

#include "vk.h"

namespace vitrail::tool {

namespace {

Unique<VkShaderModule> makeModule(Gpu& gpu, std::span<const std::uint32_t> spirv, const std::string& name) {
  auto info = vkStruct<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  info.codeSize = spirv.size_bytes();
  info.pCode = spirv.data();
  VkShaderModule module = VK_NULL_HANDLE;
  check(vkCreateShaderModule(gpu.device(), &info, nullptr, &module), fmt::format("vkCreateShaderModule ({})", name));
  setDebugName(gpu.device(), VK_OBJECT_TYPE_SHADER_MODULE, module, name);
  return {gpu.device(), module, vkDestroyShaderModule};
}

VkPipelineShaderStageCreateInfo stageInfo(VkShaderStageFlagBits stage, VkShaderModule module) {
  auto info = vkStruct<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
  info.stage = stage;
  info.module = module;
  info.pName = "main";
  return info;
}

constexpr VkColorComponentFlags kAllChannels =
    VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;

VkPipelineVertexInputStateCreateInfo vertexInput(const VertexLayout& vertices) {
  auto info = vkStruct<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
  if (vertices.attributes.empty()) return info;
  info.vertexBindingDescriptionCount = static_cast<std::uint32_t>(vertices.bindings.size());
  info.pVertexBindingDescriptions = vertices.bindings.data();
  info.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(vertices.attributes.size());
  info.pVertexAttributeDescriptions = vertices.attributes.data();
  return info;
}

VkPipelineDynamicStateCreateInfo dynamicState(const VertexLayout& vertices) {
  static constexpr std::array<VkDynamicState, 5> kStates{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                                         VK_DYNAMIC_STATE_FRONT_FACE, VK_DYNAMIC_STATE_CULL_MODE,
                                                         VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE};
  auto info = vkStruct<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
  info.dynamicStateCount = vertices.attributes.empty() ? 2 : 5;
  info.pDynamicStates = kStates.data();
  return info;
}

VkPipelineDepthStencilStateCreateInfo depthState(const GraphicsPipelineInfo& info) {
  auto state =
      vkStruct<VkPipelineDepthStencilStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
  state.depthTestEnable = info.depthTest != VK_COMPARE_OP_NEVER ? VK_TRUE : VK_FALSE;
  state.depthCompareOp = info.depthTest;
  state.depthWriteEnable = info.depthWrite ? VK_TRUE : VK_FALSE;
  state.stencilTestEnable = info.stencil ? VK_TRUE : VK_FALSE;
  if (info.stencil) state.front = state.back = *info.stencil;
  return state;
}

std::vector<VkPipelineColorBlendAttachmentState> blendStates(const GraphicsPipelineInfo& info) {
  std::vector<VkPipelineColorBlendAttachmentState> states;
  for (const ColorOutput& color : info.colors) {
    VkPipelineColorBlendAttachmentState replace{};
    replace.colorWriteMask = kAllChannels;
    states.push_back(color.blend.value_or(replace));
  }
  return states;
}

std::vector<VkFormat> colorFormats(const GraphicsPipelineInfo& info) {
  std::vector<VkFormat> formats;
  for (const ColorOutput& color : info.colors) formats.push_back(color.format);
  return formats;
}

// `formats` outlives the result.
VkPipelineRenderingCreateInfo renderingState(const GraphicsPipelineInfo& info, const std::vector<VkFormat>& formats) {
  auto state = vkStruct<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
  state.colorAttachmentCount = static_cast<std::uint32_t>(formats.size());
  state.pColorAttachmentFormats = formats.data();
  state.depthAttachmentFormat = info.depthFormat;
  if (info.depthFormat == VK_FORMAT_D32_SFLOAT_S8_UINT) state.stencilAttachmentFormat = info.depthFormat;
  return state;
}

// Specialization constants in Vulkan's words.
class Constants {
 public:
  explicit Constants(const PipelineConstants& constants) {
    for (const auto& [id, value] : constants) {
      entries_.push_back({id, static_cast<std::uint32_t>(values_.size() * sizeof(value)), sizeof(value)});
      values_.push_back(value);
    }
    info_ = {static_cast<std::uint32_t>(entries_.size()), entries_.data(), values_.size() * sizeof(std::uint32_t),
             values_.data()};
  }
  Constants(const Constants&) = delete;
  Constants& operator=(const Constants&) = delete;

  const VkSpecializationInfo* get() const { return &info_; }

 private:
  std::vector<VkSpecializationMapEntry> entries_;
  std::vector<std::uint32_t> values_;
  VkSpecializationInfo info_{};
};

VkPipelineRasterizationStateCreateInfo rasterization() {
  auto info =
      vkStruct<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
  info.polygonMode = VK_POLYGON_MODE_FILL;
  info.cullMode = VK_CULL_MODE_NONE;
  info.lineWidth = 1.0F;
  return info;
}

// The same places in every pixel, one a sample. They outlive the result.
VkPipelineSampleLocationsStateCreateInfoEXT samplesAt(const std::vector<VkSampleLocationEXT>& places) {
  auto state = vkStruct<VkPipelineSampleLocationsStateCreateInfoEXT>(
      VK_STRUCTURE_TYPE_PIPELINE_SAMPLE_LOCATIONS_STATE_CREATE_INFO_EXT);
  state.sampleLocationsEnable = VK_TRUE;
  state.sampleLocationsInfo = vkStruct<VkSampleLocationsInfoEXT>(VK_STRUCTURE_TYPE_SAMPLE_LOCATIONS_INFO_EXT);
  state.sampleLocationsInfo.sampleLocationsPerPixel = flagOf(static_cast<std::uint32_t>(places.size()));
  state.sampleLocationsInfo.sampleLocationGridSize = {1, 1};
  state.sampleLocationsInfo.sampleLocationsCount = static_cast<std::uint32_t>(places.size());
  state.sampleLocationsInfo.pSampleLocations = places.data();
  return state;
}

} // namespace

Unique<VkPipelineLayout> makePipelineLayout(Gpu& gpu, const std::vector<VkDescriptorSetLayout>& sets,
                                            const PushConstants& constants, const std::string& name) {
  const VkPushConstantRange range{constants.stages, 0, constants.bytes};
  auto info = vkStruct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
  info.pSetLayouts = sets.data();
  info.pushConstantRangeCount = constants.bytes > 0 ? 1 : 0;
  info.pPushConstantRanges = &range;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  check(vkCreatePipelineLayout(gpu.device(), &info, nullptr, &layout),
        fmt::format("vkCreatePipelineLayout ({})", name));
  setDebugName(gpu.device(), VK_OBJECT_TYPE_PIPELINE_LAYOUT, layout, name);
  return {gpu.device(), layout, vkDestroyPipelineLayout};
}

Unique<VkPipeline> makeComputePipeline(Gpu& gpu, VkPipelineLayout layout, std::span<const std::uint32_t> spirv,
                                       const std::string& name, const PipelineConstants& constants) {
  const Unique<VkShaderModule> module = makeModule(gpu, spirv, name);
  const Constants specialization(constants);
  auto info = vkStruct<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
  info.stage = stageInfo(VK_SHADER_STAGE_COMPUTE_BIT, module.get());
  info.stage.pSpecializationInfo = specialization.get();
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(gpu.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        fmt::format("vkCreateComputePipelines ({})", name));
  setDebugName(gpu.device(), VK_OBJECT_TYPE_PIPELINE, pipeline, name);
  return {gpu.device(), pipeline, vkDestroyPipeline};
}

VkPipelineColorBlendAttachmentState blendWith(const BlendFactors& color, const BlendFactors& alpha) {
  VkPipelineColorBlendAttachmentState state{};
  state.blendEnable = VK_TRUE;
  state.srcColorBlendFactor = color.src;
  state.dstColorBlendFactor = color.dst;
  state.colorBlendOp = VK_BLEND_OP_ADD;
  state.srcAlphaBlendFactor = alpha.src;
  state.dstAlphaBlendFactor = alpha.dst;
  state.alphaBlendOp = VK_BLEND_OP_ADD;
  state.colorWriteMask = kAllChannels;
  return state;
}

Unique<VkPipeline> makeGraphicsPipeline(Gpu& gpu, const GraphicsPipelineInfo& info) {
  const Unique<VkShaderModule> vertex = makeModule(gpu, info.vertexShader, info.name + " vertex shader");
  const Unique<VkShaderModule> fragment = makeModule(gpu, info.fragmentShader, info.name + " fragment shader");
  const Constants constants(info.constants);
  std::array<VkPipelineShaderStageCreateInfo, 2> stages{stageInfo(VK_SHADER_STAGE_VERTEX_BIT, vertex.get()),
                                                        stageInfo(VK_SHADER_STAGE_FRAGMENT_BIT, fragment.get())};
  stages[0].pSpecializationInfo = stages[1].pSpecializationInfo = constants.get();

  const auto vertices = vertexInput(info.vertices);
  auto assembly =
      vkStruct<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
  assembly.topology = info.topology;
  auto viewport = vkStruct<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
  viewport.viewportCount = 1;
  viewport.scissorCount = 1;
  const auto raster = rasterization();
  auto multisample =
      vkStruct<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
  multisample.rasterizationSamples = info.samples;
  multisample.pSampleMask = &info.sampleMask;
  multisample.sampleShadingEnable = info.shadeEverySample ? VK_TRUE : VK_FALSE;
  multisample.minSampleShading = 1.0F;
  const std::vector<VkSampleLocationEXT> middle(static_cast<std::size_t>(info.samples), {0.5F, 0.5F});
  const auto locations = samplesAt(middle);
  if (info.samplesInMiddle) multisample.pNext = &locations;
  const auto depth = depthState(info);
  const std::vector<VkPipelineColorBlendAttachmentState> blending = blendStates(info);
  const std::vector<VkFormat> formats = colorFormats(info);
  const auto rendering = renderingState(info, formats);
  auto blend = vkStruct<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
  blend.attachmentCount = static_cast<std::uint32_t>(blending.size());
  blend.pAttachments = blending.data();
  const auto dynamic = dynamicState(info.vertices);

  auto create = vkStruct<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
  create.pNext = &rendering;
  create.stageCount = static_cast<std::uint32_t>(stages.size());
  create.pStages = stages.data();
  create.pVertexInputState = &vertices;
  create.pInputAssemblyState = &assembly;
  create.pViewportState = &viewport;
  create.pRasterizationState = &raster;
  create.pMultisampleState = &multisample;
  create.pDepthStencilState = &depth;
  create.pColorBlendState = &blend;
  create.pDynamicState = &dynamic;
  create.layout = info.layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(gpu.device(), VK_NULL_HANDLE, 1, &create, nullptr, &pipeline),
        fmt::format("vkCreateGraphicsPipelines ({})", info.name));
  setDebugName(gpu.device(), VK_OBJECT_TYPE_PIPELINE, pipeline, info.name);
  return {gpu.device(), pipeline, vkDestroyPipeline};
}

} // namespace vitrail::tool
