// Creation, resizing and destruction of a target.
#include "target.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <new>

#include "check_target.h"

namespace vitrail {

namespace {

// Copies what the host gave of an array of views.
const VkImageView* keep(const VkImageView* given, std::uint32_t count,
                        std::array<VkImageView, VITRAIL_MAX_COLOR_VIEWS>& kept) {
  if (given == nullptr || count == 0) return nullptr;
  std::copy(given, given + count, kept.begin());
  return kept.data();
}

void keepViews(VitrailTarget_T& target, const VitrailViews& views) {
  target.desc.views.count = views.count;
  target.desc.views.color = keep(views.color, views.count, target.colorViews);
  target.desc.views.opaque = keep(views.opaque, views.count, target.opaqueViews);
  target.desc.views.depth = keep(views.depth, views.count, target.depthViews);
}

Specialization constantsOf(const VitrailTargetDesc& desc) {
  Specialization constants;
  constants.format = desc.nodeFormat;
  constants.samples = desc.samples;
  constants.nearestIsOne = desc.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? VK_TRUE : VK_FALSE;
  constants.maxLayers = desc.maxLayers;
  constants.testDepth = desc.samples > 1 && desc.postDepthCoverage == VK_FALSE ? VK_TRUE : VK_FALSE;
  return constants;
}

// How to sort on this device.
bool usesNetworks(const VitrailContext_T& context) {
#ifdef VITRAIL_TEST_USE_NETWORKS // so that a CPU device tests what GPUs run
  static_cast<void>(context);
  return true;
#else
  return !context.limits.isCpu;
#endif
}

VkResult findComputePipelines(VitrailTarget_T& target) {
  VitrailContext_T& context = *target.context;
  ComputeKey key;
  key.color = target.desc.colorFormat == VK_FORMAT_R32G32B32A32_SFLOAT ? ColorImage::Rgba32f : ColorImage::Rgba16f;
  key.multisampled = target.desc.samples > 1;
  key.byAddress = context.has(VITRAIL_FEATURE_BUFFER_DEVICE_ADDRESS);
  key.networks = usesNetworks(context) && context.limits.exchangesInGroups;
  key.constants = target.constants;
  const auto find = [&](Kernel kernel, VkPipeline* pipeline) {
    key.kernel = kernel;
    return computePipeline(context, key, pipeline);
  };
  const bool capped = target.desc.maxLayers != 0 && target.desc.maxLayers <= layout::VITRAIL_SHORT_LIST;
  VkResult result = find(Kernel::Resolve, &target.pipelines.shortLists);
  if (result == VK_SUCCESS && key.multisampled) result = find(Kernel::ResolvePlain, &target.pipelines.plain);
  const auto findGroup = [&](std::uint32_t group, VkPipeline* pipeline) {
    if (result != VK_SUCCESS) return;
    key.constants.group = group;
    result = find(Kernel::ResolveGroup, pipeline);
    key.constants.group = target.constants.group;
  };
  if (!capped && key.networks) {
    if (result == VK_SUCCESS) result = find(Kernel::ResolveMedium, &target.pipelines.mediumLists);
    findGroup(4, &target.pipelines.longLists);
    findGroup(8, &target.pipelines.longestLists);
  } else if (!capped && result == VK_SUCCESS) {
    result = find(Kernel::ResolveLong, &target.pipelines.longLists);
  }
  const bool apart = target.keepSums && !key.networks; // else the first kernel does it
  if (result == VK_SUCCESS && apart) result = find(Kernel::ResolveOverflow, &target.pipelines.overflow);
  return result;
}

FragmentResolve fragmentKind(const VitrailContext_T& context, const VitrailTargetDesc& desc,
                             const Specialization& constants) {
  const bool dual = context.has(VITRAIL_FEATURE_DUAL_SRC_BLEND);
  if (desc.samples == 1) return dual ? FragmentResolve::SingleDual : FragmentResolve::Single;
  if (desc.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_PIXEL) return FragmentResolve::PerPixel;
  if (constants.testDepth != VK_FALSE) {
    return dual ? FragmentResolve::PerSampleDualDepth : FragmentResolve::PerSampleDepth;
  }
  return dual ? FragmentResolve::PerSampleDual : FragmentResolve::PerSample;
}

VkResult createFragmentPipelines(VitrailTarget_T& target) {
  VitrailContext_T& context = *target.context;
  ComputeKey key;
  key.byAddress = context.has(VITRAIL_FEATURE_BUFFER_DEVICE_ADDRESS);
  key.networks = usesNetworks(context);
  key.constants = target.constants;
  key.constants.testDepth = VK_FALSE; // sorting does not look at the picture
  key.kernel = Kernel::SortFind;
  VkResult result = computePipeline(context, key, &target.pipelines.sortFind);
  key.kernel = Kernel::SortLong;
  if (result == VK_SUCCESS) result = computePipeline(context, key, &target.pipelines.sortLong);
  key.kernel = Kernel::ClearSums;
  if (result == VK_SUCCESS && target.keepSums) result = computePipeline(context, key, &target.pipelines.clearSums);
  if (result != VK_SUCCESS) return result;

  FragmentInfo info;
  info.resolve = fragmentKind(context, target.desc, target.constants);
  info.byAddress = key.byAddress;
  info.networks = key.networks;
  info.constants = target.constants;
  info.scopeSamples = info.resolve == FragmentResolve::PerPixel ? VK_SAMPLE_COUNT_1_BIT : target.desc.samples;
  info.colorFormat = target.desc.colorFormat;
  info.scope = target.desc.scope;
  result = createFragmentPipeline(context, info, &target.pipelines.fragment);
  if (result != VK_SUCCESS || info.resolve != FragmentResolve::PerPixel) return result;
  info.resolve = FragmentResolve::Plain;
  return createFragmentPipeline(context, info, &target.pipelines.fragmentPlain);
}

VkResult createStats(VitrailTarget_T& target) {
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  const VkResult result =
      target.stats.create(*target.context, statsBytes(target.desc), VK_BUFFER_USAGE_TRANSFER_DST_BIT, kHost,
                          VK_MEMORY_PROPERTY_HOST_CACHED_BIT, target.debugName.c_str(), "statistics");
  if (result != VK_SUCCESS) return result;
  for (std::uint32_t i = 0; i < target.desc.framesInFlight; ++i) {
    new (static_cast<StatsSlot*>(target.stats.mapped) + i) StatsSlot{};
  }
  return VK_SUCCESS;
}

VkResult findPreparePipeline(VitrailTarget_T& target) {
  const bool builds = target.desc.linking == VITRAIL_LINKING_COMPUTE;
  ComputeKey key;
  key.kernel = builds ? Kernel::BuildLists : Kernel::Prepare;
  key.byAddress = target.context->has(VITRAIL_FEATURE_BUFFER_DEVICE_ADDRESS);
  key.networks = false;
  key.constants.format = target.constants.format;
  key.constants.samples = target.constants.samples;
  return computePipeline(*target.context, key, builds ? &target.pipelines.buildLists : &target.pipelines.prepare);
}

// `desc` has passed checkTarget().
VkResult build(VitrailTarget_T& target, const VitrailTargetDesc& desc) {
  target.desc = desc;
  target.debugName = desc.debugName;
  target.keepSums = keepsSums(desc);
  target.constants = constantsOf(desc);
  keepViews(target, desc.views);
  if (desc.memoryBudget != 0) {
    target.desc.nodeCapacity = std::min(desc.nodeCapacity, budgetCapacity(target.context, desc, desc.areaPixels));
  }
  VkResult result = target.isCompute() ? findComputePipelines(target) : createFragmentPipelines(target);
  if (result == VK_SUCCESS) result = findPreparePipeline(target);
  if (result == VK_SUCCESS) result = createStats(target);
  if (result == VK_SUCCESS) {
    result = target.storage.create(*target.context, storageInfo(target, target.desc.nodeCapacity));
  }
  return result;
}

} // namespace

StorageInfo storageInfo(const VitrailTarget_T& target, std::uint32_t nodeCapacity) {
  StorageInfo info;
  info.areaPixels = target.desc.areaPixels;
  info.nodeCapacity = nodeCapacity;
  info.format = target.desc.nodeFormat;
  info.keepSums = target.keepSums;
  info.buffer = target.desc.buffer;
  info.bufferOffset = target.desc.bufferOffset;
  info.views = target.desc.views;
  info.debugName = target.debugName.c_str();
  return info;
}

VkResult replaceStorage(VitrailTarget_T& target, const StorageInfo& info, std::uint64_t frame) {
  Storage made;
  const VkResult result = made.create(*target.context, info);
  if (result != VK_SUCCESS) {
    made.destroy(*target.context);
    return result;
  }
  target.retired.push_back({target.storage, frame == 0 ? 0 : frame - 1});
  target.storage = made;
  return VK_SUCCESS;
}

void freeRetired(VitrailTarget_T& target, std::uint64_t frame) {
  // That the host records `frame` says that frame - framesInFlight has finished.
  const auto finished = [&](Retired& retired) {
    if (frame < target.desc.framesInFlight || retired.lastFrame > frame - target.desc.framesInFlight) return false;
    retired.storage.destroy(*target.context);
    return true;
  };
  target.retired.erase(std::remove_if(target.retired.begin(), target.retired.end(), finished), target.retired.end());
}

} // namespace vitrail

extern "C" VitrailResolve vitrailDefaultResolve(VitrailContext context, const VitrailTargetDesc* desc) {
  const bool perSample = desc->samples > 1 && desc->msaaResolve == VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  const VkFormat format = desc->colorFormat != VK_FORMAT_UNDEFINED ? desc->colorFormat : VK_FORMAT_R16G16B16A16_SFLOAT;
  const bool writable = format == VK_FORMAT_R16G16B16A16_SFLOAT || format == VK_FORMAT_R32G32B32A32_SFLOAT;
  if (perSample || !writable || desc->views.count == 0 || desc->views.color == nullptr) return VITRAIL_RESOLVE_FRAGMENT;
  VkFormatProperties properties{};
  context->vk.GetPhysicalDeviceFormatProperties(context->physicalDevice, format, &properties);
  const bool stores = (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) != 0;
  return stores ? VITRAIL_RESOLVE_COMPUTE : VITRAIL_RESOLVE_FRAGMENT;
}

extern "C" VitrailLinking vitrailDefaultLinking(VitrailContext context, const VitrailTargetDesc* desc) {
  const bool fits = vitrail::withAreaPixels(*desc).areaPixels <= VITRAIL_MAX_PIXELS_LINKED_BY_COMPUTE;
  return fits && context->limits.fewFragmentCores ? VITRAIL_LINKING_COMPUTE : VITRAIL_LINKING_FRAGMENT;
}

extern "C" VkResult vitrailTargetRequirements(VitrailContext context, const VitrailTargetDesc* desc,
                                              VitrailRequirements* requirements) {
  *requirements = {};
  const VitrailTargetDesc full = vitrail::withDefaults(context, *desc);
  const VkResult result = vitrail::checkMemory(context, full);
  if (result != VK_SUCCESS) return result;
  requirements->size = vitrail::layoutStorage(full.areaPixels, full.nodeCapacity, full.nodeFormat,
                                              vitrail::keepsSums(full), context->limits.alignment)
                           .total;
  requirements->alignment = context->limits.alignment;
  requirements->usage = vitrail::storageUsage(*context);
  return VK_SUCCESS;
}

extern "C" VkResult vitrailCreateTarget(VitrailContext context, const VitrailTargetDesc* desc, VitrailTarget* target) {
  if (target == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  *target = nullptr;
  if (context == nullptr || desc == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  const VitrailTargetDesc full = vitrail::withDefaults(context, *desc);
  VkResult result = vitrail::checkTarget(context, full);
  if (result != VK_SUCCESS) return result;

  std::unique_ptr<VitrailTarget_T> made(new (std::nothrow) VitrailTarget_T);
  if (!made) return context->log.fail(VK_ERROR_OUT_OF_HOST_MEMORY, "no memory for a target");
  made->context = context;
  result = vitrail::build(*made, full);
  if (result != VK_SUCCESS) {
    vitrailDestroyTarget(made.release());
    return result; // the log has the reason
  }
  *target = made.release();
  return VK_SUCCESS;
}

extern "C" void vitrailDestroyTarget(VitrailTarget target) {
  if (target == nullptr) return;
  const std::unique_ptr<VitrailTarget_T> owned(target);
  const VitrailContext_T& context = *target->context;
  for (vitrail::Retired& retired : target->retired) retired.storage.destroy(context);
  target->storage.destroy(context);
  target->stats.destroy(context);
  context.vk.DestroyPipeline(context.device, target->pipelines.fragment, context.allocator);
  context.vk.DestroyPipeline(context.device, target->pipelines.fragmentPlain, context.allocator);
}

extern "C" VkResult vitrailResizeTarget(VitrailTarget target, const VitrailResizeInfo* info) {
  VitrailContext context = target->context;
  if (target->desc.buffer != VK_NULL_HANDLE) {
    return context->log.fail(VK_ERROR_INITIALIZATION_FAILED,
                             "a target in the host's memory cannot be resized: make another one");
  }
  VitrailTargetDesc wanted = target->desc;
  wanted.extent = info->extent;
  wanted.areaPixels = info->areaPixels;
  wanted.views = info->views;
  if (wanted.memoryBudget != 0) wanted.nodeCapacity = target->storage.nodeCapacity;
  wanted = vitrail::withDefaults(context, wanted);
  VkResult result = vitrail::checkTarget(context, wanted);
  if (result != VK_SUCCESS) return result;
  if (wanted.memoryBudget != 0) {
    wanted.nodeCapacity = std::min(wanted.nodeCapacity, vitrail::budgetCapacity(context, wanted, wanted.areaPixels));
  }
  vitrail::StorageInfo storage = vitrail::storageInfo(*target, wanted.nodeCapacity);
  storage.areaPixels = wanted.areaPixels;
  storage.views = wanted.views;
  vitrail::freeRetired(*target, info->frame);
  result = vitrail::replaceStorage(*target, storage, info->frame);
  if (result != VK_SUCCESS) return result;
  target->desc.extent = wanted.extent;
  target->desc.areaPixels = wanted.areaPixels;
  vitrail::keepViews(*target, wanted.views);
  target->demand = {};
  return VK_SUCCESS;
}

extern "C" VkDescriptorSet vitrailTargetDescriptorSet(VitrailTarget target) { return target->storage.set; }

extern "C" VitrailLinking vitrailTargetLinking(VitrailTarget target) { return target->desc.linking; }

extern "C" void vitrailTargetMemory(VitrailTarget target, VitrailMemory* memory) {
  const vitrail::Storage& storage = target->storage;
  *memory = {};
  memory->nodeCapacity = storage.nodeCapacity;
  memory->nodeBytes = storage.layout.nodes.size;
  memory->headBytes = storage.layout.heads.size;
  memory->totalBytes = storage.layout.total + target->stats.size;
  memory->otherBytes = memory->totalBytes - memory->nodeBytes - memory->headBytes;
  for (const vitrail::Retired& retired : target->retired) memory->totalBytes += retired.storage.layout.total;
}

extern "C" void vitrailCollectSpecialization(VitrailContext context, const VitrailTargetDesc* desc,
                                             VitrailSpecialization* specialization) {
  constexpr std::uint32_t kFirstId = 1700; // VITRAIL_CONSTANT_ID of shaders/vitrail/collect.glsl
  specialization->data[0] = desc->nodeFormat;
  specialization->data[1] = desc->samples != 0 ? desc->samples : VK_SAMPLE_COUNT_1_BIT;
  specialization->data[2] = vitrail::keepsSums(*desc) ? 1 : 0;
  const VitrailLinking linking =
      desc->linking != VITRAIL_LINKING_DEFAULT ? desc->linking : vitrailDefaultLinking(context, desc);
  specialization->data[3] = linking == VITRAIL_LINKING_COMPUTE ? 1 : 0;
  specialization->data[4] = 0;
  for (std::uint32_t i = 0; i < std::size(specialization->data); ++i) {
    specialization->entries[i] = {kFirstId + i, static_cast<std::uint32_t>(i * sizeof(std::uint32_t)),
                                  sizeof(std::uint32_t)};
  }
}

extern "C" void vitrailStencilMark(VkStencilOpState* state) {
  *state = {};
  state->failOp = VK_STENCIL_OP_KEEP;
  state->passOp = VK_STENCIL_OP_INCREMENT_AND_CLAMP;
  state->depthFailOp = VK_STENCIL_OP_KEEP;
  state->compareOp = VK_COMPARE_OP_ALWAYS;
  state->compareMask = 0xffU;
  state->writeMask = 0xffU;
}
