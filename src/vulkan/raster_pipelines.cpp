// The layouts and pipelines of a raster: the host's shader in its stages, and the library's kernels.
#include <algorithm>
#include <cstring>
#include <span>

#include "kernels/raster_includes.inc"
#include "raster.h"

namespace vitrail {

namespace {

constexpr std::uint32_t kPushBytes = sizeof(RasterBegin); // more than the other passes take

// The constants of frame.glsl, in the order of their ids.
struct RasterConstants {
  std::uint32_t samples = 1;
  VkBool32 shuffles = VK_FALSE;
  VkBool32 positions = VK_FALSE;
  std::uint32_t keep = 16;
  std::uint32_t batches = 1;
  std::uint32_t triangleClass = 0;
  std::uint32_t blends = 0;
  VkBool32 onlyTriangles = VK_FALSE;
  VkBool32 nearestIsZero = VK_FALSE;
  std::uint32_t indexBytes = 4;
  std::uint32_t turns = 2;
  std::uint32_t vertices = 2;
};
constexpr std::uint32_t kConstantCount = sizeof(RasterConstants) / sizeof(std::uint32_t);

RasterConstants constantsOf(const VitrailVkRaster_T& raster) {
  RasterConstants constants;
  constants.samples = raster.samples;
  constants.shuffles = raster.shuffles ? VK_TRUE : VK_FALSE;
  constants.positions = raster.keepsPositions ? VK_TRUE : VK_FALSE;
  constants.blends = raster.blendModes;
  constants.onlyTriangles = raster.solids ? VK_FALSE : VK_TRUE;
  constants.nearestIsZero = raster.nearestIsZero ? VK_TRUE : VK_FALSE;
  constants.indexBytes = raster.indexBytes;
  constants.turns = rasterTurns(raster.samples);
  constants.vertices = raster.verticesOfThread;
  return constants;
}

VkResult createModule(const VitrailVkRaster_T& raster, std::span<const std::uint32_t> code, const char* name,
                      VkShaderModule* module) {
  const VitrailVkContext_T& context = *raster.context;
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = code.size_bytes();
  info.pCode = code.data();
  const VkResult result = context.vk.CreateShaderModule(context.device, &info, context.allocator, module);
  if (result != VK_SUCCESS) return context.log.fail(result, "%s %s: no shader module", raster.debugName.c_str(), name);
  return VK_SUCCESS;
}

// The host's specialization, and behind it room for the library's.
VkResult keepStage(const VitrailVkRaster_T& raster, const VitrailVkRasterStage& given, const char* name,
                   RasterStage& stage) {
  if (given.specialization != nullptr) {
    const VkSpecializationInfo& host = *given.specialization;
    stage.entries.assign(host.pMapEntries, host.pMapEntries + host.mapEntryCount);
    stage.data.resize(host.dataSize);
    if (host.dataSize > 0) std::memcpy(stage.data.data(), host.pData, host.dataSize);
  }
  return createModule(raster, {given.code, given.size / sizeof(std::uint32_t)}, name, &stage.module);
}

void destroyStage(const VitrailVkContext_T& context, RasterStage& stage) {
  context.vk.DestroyShaderModule(context.device, stage.module, context.allocator);
  stage = {};
}

VkResult createPipeline(const VitrailVkRaster_T& raster, VkPipelineLayout layout, const RasterStage& stage,
                        const RasterConstants& constants, const char* name, VkPipeline* pipeline) {
  const VitrailVkContext_T& context = *raster.context;
  std::vector<VkSpecializationMapEntry> entries = stage.entries;
  std::vector<std::uint8_t> data = stage.data;
  data.resize((data.size() + 3) / 4 * 4);
  for (std::uint32_t i = 0; i < kConstantCount; ++i) {
    entries.push_back({kFirstRasterConstant + i, static_cast<std::uint32_t>(data.size() + i * sizeof(std::uint32_t)),
                       sizeof(std::uint32_t)});
  }
  const std::size_t end = data.size();
  data.resize(end + sizeof(constants));
  std::memcpy(data.data() + end, &constants, sizeof(constants));
  const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(), data.size(),
                                            data.data()};
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = stage.module;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &specialization;
  info.layout = layout;
  const VkResult result =
      context.vk.CreateComputePipelines(context.device, context.cache, 1, &info, context.allocator, pipeline);
  if (result != VK_SUCCESS) return context.log.fail(result, "%s %s: no pipeline", raster.debugName.c_str(), name);
  context.name(VK_OBJECT_TYPE_PIPELINE, *pipeline, (raster.debugName + ' ' + name).c_str());
  return VK_SUCCESS;
}

// A kernel of the table, and one variant of it: an axis of `any` serves all.
enum class KernelMade : std::uint8_t { first, deep };
struct KernelRow {
  const char* name;
  KernelMade made;
};
constexpr std::array kKernelRows = {
#define VITRAIL_RASTER_KERNEL(name, words, made) KernelRow{words, KernelMade::made},
#include "kernels/raster_names.inc"
#undef VITRAIL_RASTER_KERNEL
};
static_assert(kKernelRows.size() == kRasterKernels);

enum class KernelColor : std::uint8_t { any, rgba16f, rgba32f };
enum class KernelSamples : std::uint8_t { any, one, several };
struct KernelVariant {
  RasterKernel kernel;
  KernelColor color;
  KernelSamples samples;
  std::span<const std::uint32_t> code;
};
constexpr std::array kKernelVariants = {
#define VITRAIL_RASTER_VARIANT(name, color, samples, symbol) \
  KernelVariant{RasterKernel::name, KernelColor::color, KernelSamples::samples, shaders::symbol},
#include "kernels/raster_variants.inc"
#undef VITRAIL_RASTER_VARIANT
};

// Empty: a raster like this one does without.
std::span<const std::uint32_t> kernelCode(const VitrailVkRaster_T& raster, RasterKernel kernel) {
  const bool wide = raster.colorFormat == VK_FORMAT_R32G32B32A32_SFLOAT;
  const KernelColor color = wide ? KernelColor::rgba32f : KernelColor::rgba16f;
  const KernelSamples samples = raster.samples > 1 ? KernelSamples::several : KernelSamples::one;
  for (const KernelVariant& variant : kKernelVariants) {
    const bool suits = (variant.color == KernelColor::any || variant.color == color) &&
                       (variant.samples == KernelSamples::any || variant.samples == samples);
    if (variant.kernel == kernel && suits) return variant.code;
  }
  return {};
}

VkResult createKernels(VitrailVkRaster_T& raster, KernelMade made) {
  for (std::size_t i = 0; i < kRasterKernels; ++i) {
    const auto& [name, madeThen] = kKernelRows.at(i);
    const std::span<const std::uint32_t> code = kernelCode(raster, static_cast<RasterKernel>(i));
    if (madeThen != made || code.empty()) continue;
    if (raster.kernels[i] != VK_NULL_HANDLE) continue; // of a call that made some, and failed then
    RasterStage stage;
    VkResult result = createModule(raster, code, name, &stage.module);
    if (result == VK_SUCCESS) {
      result =
          createPipeline(raster, raster.layout(RasterSet::Own), stage, constantsOf(raster), name, &raster.kernels[i]);
    }
    destroyStage(*raster.context, stage);
    if (result != VK_SUCCESS) return result;
  }
  return VK_SUCCESS;
}

VkResult createSetLayout(VitrailVkRaster_T& raster, RasterSet set, VkDescriptorSetLayout* layout) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (std::uint32_t i = 0; i < kRasterBindings; ++i) {
    if (!hasRasterBinding(set, raster.samples, i)) continue;
    bindings.push_back({i, rasterBindingType(i), 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  }
  VkDescriptorSetLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  const VitrailVkContext_T& context = *raster.context;
  const VkResult result = context.vk.CreateDescriptorSetLayout(context.device, &info, context.allocator, layout);
  if (result == VK_SUCCESS) context.name(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, *layout, raster.debugName.c_str());
  return result;
}

VkResult createLayout(VitrailVkRaster_T& raster, std::span<const VkDescriptorSetLayout> sets,
                      VkPipelineLayout* layout) {
  const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, kPushBytes};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
  info.pSetLayouts = sets.data();
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &push;
  const VitrailVkContext_T& context = *raster.context;
  const VkResult result = context.vk.CreatePipelineLayout(context.device, &info, context.allocator, layout);
  if (result == VK_SUCCESS) context.name(VK_OBJECT_TYPE_PIPELINE_LAYOUT, *layout, raster.debugName.c_str());
  return result;
}

VkResult createLayouts(VitrailVkRaster_T& raster, const VitrailVkRasterDesc& desc) {
  for (std::size_t i = 0; i < kRasterSets; ++i) {
    const auto set = static_cast<RasterSet>(i);
    VkResult result = createSetLayout(raster, set, &raster.setLayouts[i]);
    std::vector<VkDescriptorSetLayout> sets;
    if (set != RasterSet::Own) sets.assign(desc.setLayouts, desc.setLayouts + desc.setLayoutCount);
    sets.push_back(raster.setLayouts[i]);
    if (result == VK_SUCCESS) result = createLayout(raster, sets, &raster.layouts[i]);
    if (result != VK_SUCCESS) return result;
  }
  return VK_SUCCESS;
}

// One pipeline of a stage before blending, for a class of triangles where it asks.
VkResult createGeometryPipeline(VitrailVkRaster_T& raster, const VitrailVkRasterStage& given, const char* name,
                                VkPipeline* pipeline, std::uint32_t triangleClass = 0) {
  RasterStage stage;
  VkResult result = keepStage(raster, given, name, stage);
  if (result == VK_SUCCESS) {
    RasterConstants constants = constantsOf(raster);
    constants.triangleClass = triangleClass;
    result = createPipeline(raster, raster.layout(RasterSet::Geometry), stage, constants, name, pipeline);
  }
  destroyStage(*raster.context, stage);
  return result;
}

// Tiles with few records, or of which no pixel is deep, keep fewer of a pixel's fragments in registers, so that more
// work groups run at a time. A CPU runs as many of any pipeline, and takes a second and more to compile each: there the
// last one blends all tiles.
VkResult createBlends(VitrailVkRaster_T& raster, const VitrailVkRasterStage& given) {
  constexpr std::array<std::uint32_t, kRasterBlends> kKeep = {8, 16, 16, 32};
  const std::uint32_t atOnce = raster.samples > 1 ? 2 : 1; // batches
  const std::array<std::uint32_t, kRasterBlends> batches = {0, 0, atOnce, 1};
  RasterStage stage;
  VkResult result = keepStage(raster, given, "blend", stage);
  const std::uint32_t first = raster.context->limits.oneBlend ? kRasterBlends - 1 : 0;
  for (std::uint32_t i = first; result == VK_SUCCESS && i < kRasterBlends; ++i) {
    RasterConstants constants = constantsOf(raster);
    constants.keep = kKeep[i];
    constants.batches = batches.at(i);
    result = createPipeline(raster, raster.layout(RasterSet::Blend), stage, constants, "blend", &raster.blends[i]);
  }
  destroyStage(*raster.context, stage);
  return result;
}

} // namespace

VkResult createRasterPipelines(VitrailVkRaster_T& raster, const VitrailVkRasterDesc& desc) {
  const VitrailVkContext_T& context = *raster.context;
  VkResult result = createLayouts(raster, desc);
  if (result != VK_SUCCESS) return context.log.fail(result, "%s: no pipeline layout", raster.debugName.c_str());
  if (raster.keepsPositions) result = createGeometryPipeline(raster, desc.positions, "positions", &raster.positions);
  if (result == VK_SUCCESS) result = createGeometryPipeline(raster, desc.setUp, "set up", &raster.setUp);
  if (result == VK_SUCCESS)
    result = createGeometryPipeline(raster, desc.setUpLarge, "set up medium", &raster.setUpMedium, 0);
  if (result == VK_SUCCESS)
    result = createGeometryPipeline(raster, desc.setUpLarge, "set up large", &raster.setUpLarge, 1);
  if (result == VK_SUCCESS) result = createBlends(raster, desc.blend);
  if (result == VK_SUCCESS) result = keepStage(raster, desc.blendDeep, "blend deep", raster.deepStage);
  if (result == VK_SUCCESS) result = createKernels(raster, KernelMade::first);
  return result;
}

VkResult createDeepPipelines(VitrailVkRaster_T& raster) {
  if (raster.blendDeep != VK_NULL_HANDLE) return VK_SUCCESS;
  const VkResult result = createKernels(raster, KernelMade::deep);
  if (result != VK_SUCCESS) return result;
  return createPipeline(raster, raster.layout(RasterSet::Blend), raster.deepStage, constantsOf(raster), "blend deep",
                        &raster.blendDeep);
}

void destroyRasterPipelines(VitrailVkRaster_T& raster) {
  const VitrailVkContext_T& context = *raster.context;
  const auto destroy = [&](VkPipeline pipeline) {
    context.vk.DestroyPipeline(context.device, pipeline, context.allocator);
  };
  for (const VkPipeline pipeline :
       {raster.positions, raster.setUp, raster.setUpMedium, raster.setUpLarge, raster.blendDeep}) {
    destroy(pipeline);
  }
  for (const VkPipeline pipeline : raster.blends) destroy(pipeline);
  for (const VkPipeline pipeline : raster.kernels) destroy(pipeline);
  destroyStage(context, raster.deepStage);
  for (const VkPipelineLayout layout : raster.layouts) {
    context.vk.DestroyPipelineLayout(context.device, layout, context.allocator);
  }
  for (const VkDescriptorSetLayout layout : raster.setLayouts) {
    context.vk.DestroyDescriptorSetLayout(context.device, layout, context.allocator);
  }
}

} // namespace vitrail
