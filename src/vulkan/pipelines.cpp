#include "pipelines.h"

#include <array>
#include <cstddef>
#include <cstdio>

#include "context.h"

namespace vitrail {

namespace {

constexpr std::array<VkSpecializationMapEntry, 6> kConstants = {
    VkSpecializationMapEntry{0, offsetof(Specialization, format), sizeof(std::uint32_t)},
    VkSpecializationMapEntry{1, offsetof(Specialization, samples), sizeof(std::uint32_t)},
    VkSpecializationMapEntry{2, offsetof(Specialization, nearestIsOne), sizeof(VkBool32)},
    VkSpecializationMapEntry{3, offsetof(Specialization, maxLayers), sizeof(std::uint32_t)},
    VkSpecializationMapEntry{4, offsetof(Specialization, testDepth), sizeof(VkBool32)},
    VkSpecializationMapEntry{5, offsetof(Specialization, group), sizeof(std::uint32_t)},
};

VkSpecializationInfo specializationInfo(const Specialization& constants) {
  return {static_cast<std::uint32_t>(kConstants.size()), kConstants.data(), sizeof(constants), &constants};
}

// "vitrail" and what it is.
template <class Handle>
void nameOf(const VitrailVkContext_T& context, VkObjectType type, Handle handle, const char* what) {
  char text[64];
  std::snprintf(text, sizeof(text), "vitrail %s", what);
  context.name(type, handle, text);
}

// A shader module for as long as a pipeline is being made.
class Module {
 public:
  explicit Module(const VitrailVkContext_T& context) : context_(context) {}
  ~Module() { context_.vk.DestroyShaderModule(context_.device, module_, context_.allocator); }
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;

  VkResult create(Spirv code, const char* name) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    const VkResult result = context_.vk.CreateShaderModule(context_.device, &info, context_.allocator, &module_);
    if (result == VK_SUCCESS) nameOf(context_, VK_OBJECT_TYPE_SHADER_MODULE, module_, name);
    return result;
  }

  [[nodiscard]] VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits stage,
                                                      const VkSpecializationInfo* constants) const {
    VkPipelineShaderStageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage = stage;
    info.module = module_;
    info.pName = "main";
    info.pSpecializationInfo = constants;
    return info;
  }

 private:
  const VitrailVkContext_T& context_;
  VkShaderModule module_ = VK_NULL_HANDLE;
};

VkResult createComputePipeline(const VitrailVkContext_T& context, const ComputeKey& key, VkPipeline* pipeline) {
  Module shader(context);
  const char* name = kernelName(key.kernel);
  VkResult result =
      shader.create(kernelCode(key.kernel, key.color, key.multisampled, key.byAddress, key.networks), name);
  if (result != VK_SUCCESS) return result;
  const VkSpecializationInfo constants = specializationInfo(key.constants);
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage = shader.stage(VK_SHADER_STAGE_COMPUTE_BIT, &constants);
  info.layout = context.resolveLayout;
  result = context.vk.CreateComputePipelines(context.device, context.cache, 1, &info, context.allocator, pipeline);
  if (result == VK_SUCCESS) nameOf(context, VK_OBJECT_TYPE_PIPELINE, *pipeline, name);
  return result;
}

// C + T * d: one alpha for all channels, or a transmittance of their own. What is written whole is not blended.
VkPipelineColorBlendAttachmentState blendState(FragmentResolve resolve) {
  VkPipelineColorBlendAttachmentState state{};
  state.colorWriteMask =
      VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  if (resolve == FragmentResolve::PerPixel || resolve == FragmentResolve::Plain) return state;
  const bool dual = resolve == FragmentResolve::SingleDual || resolve == FragmentResolve::PerSampleDual ||
                    resolve == FragmentResolve::PerSampleDualDepth;
  state.blendEnable = VK_TRUE;
  state.srcColorBlendFactor = VK_BLEND_FACTOR_ONE;
  state.dstColorBlendFactor = dual ? VK_BLEND_FACTOR_SRC1_COLOR : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  state.dstAlphaBlendFactor = dual ? VK_BLEND_FACTOR_SRC1_ALPHA : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  return state;
}

VkPipelineDepthStencilStateCreateInfo stencilState(const VitrailVkScope& scope) {
  VkPipelineDepthStencilStateCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  info.stencilTestEnable = scope.stencilMark;
  info.front.compareOp = VK_COMPARE_OP_NOT_EQUAL; // to 0
  info.front.compareMask = scope.stencilMask != 0 ? scope.stencilMask : 0xffU;
  info.back = info.front;
  return info;
}

// Where the scope is no render pass. Points into `info`.
VkPipelineRenderingCreateInfo renderingInfo(const FragmentInfo& info) {
  VkPipelineRenderingCreateInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &info.colorFormat;
  rendering.depthAttachmentFormat = info.scope.depthFormat;
  rendering.stencilAttachmentFormat = info.scope.stencilFormat;
  return rendering;
}

} // namespace

VkResult computePipeline(VitrailVkContext_T& context, const ComputeKey& key, VkPipeline* pipeline) {
  const std::lock_guard lock(context.pipelinesMutex);
  VkPipeline& kept = context.pipelines[key];
  if (kept == VK_NULL_HANDLE) {
    const VkResult result = createComputePipeline(context, key, &kept);
    if (result != VK_SUCCESS) return context.log.fail(result, "%s: no pipeline", kernelName(key.kernel));
  }
  *pipeline = kept;
  return VK_SUCCESS;
}

VkResult createFragmentPipeline(const VitrailVkContext_T& context, const FragmentInfo& info, VkPipeline* pipeline) {
  Module vertexShader(context);
  Module fragmentShader(context);
  VkResult result = vertexShader.create(vertexCode(), "resolve vertex");
  if (result == VK_SUCCESS) {
    result = fragmentShader.create(fragmentCode(info.resolve, info.byAddress, info.networks), "resolve fragment");
  }
  if (result != VK_SUCCESS) return context.log.fail(result, "the fragment resolve's shaders could not be created");
  const VkSpecializationInfo constants = specializationInfo(info.constants);
  const std::array<VkPipelineShaderStageCreateInfo, 2> stages = {
      vertexShader.stage(VK_SHADER_STAGE_VERTEX_BIT, nullptr),
      fragmentShader.stage(VK_SHADER_STAGE_FRAGMENT_BIT, &constants)};

  VkPipelineVertexInputStateCreateInfo input{};
  input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{};
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = 1;
  viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.lineWidth = 1.0F;
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = info.scopeSamples;
  const VkPipelineDepthStencilStateCreateInfo depthStencil = stencilState(info.scope);
  const VkPipelineColorBlendAttachmentState attachment = blendState(info.resolve);
  VkPipelineColorBlendStateCreateInfo blend{};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = 1;
  blend.pAttachments = &attachment;
  constexpr std::array<VkDynamicState, 2> kDynamic = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{};
  dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
  dynamic.dynamicStateCount = kDynamic.size();
  dynamic.pDynamicStates = kDynamic.data();
  const VkPipelineRenderingCreateInfo rendering = renderingInfo(info);

  VkGraphicsPipelineCreateInfo create{};
  create.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  create.pNext = info.scope.renderPass == VK_NULL_HANDLE ? &rendering : nullptr;
  create.stageCount = stages.size();
  create.pStages = stages.data();
  create.pVertexInputState = &input;
  create.pInputAssemblyState = &assembly;
  create.pViewportState = &viewport;
  create.pRasterizationState = &raster;
  create.pMultisampleState = &samples;
  create.pDepthStencilState = &depthStencil;
  create.pColorBlendState = &blend;
  create.pDynamicState = &dynamic;
  create.layout = context.resolveLayout;
  create.renderPass = info.scope.renderPass;
  create.subpass = info.scope.subpass;
  result = context.vk.CreateGraphicsPipelines(context.device, context.cache, 1, &create, context.allocator, pipeline);
  if (result != VK_SUCCESS) return context.log.fail(result, "the fragment resolve's pipeline could not be created");
  context.name(VK_OBJECT_TYPE_PIPELINE, *pipeline, "vitrail resolve fragment");
  return VK_SUCCESS;
}

} // namespace vitrail
