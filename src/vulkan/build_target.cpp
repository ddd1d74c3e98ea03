// What a target is made of: pipelines of its plan, statistics, memory.
#include <algorithm>
#include <new>

#include "target.h"

namespace vitrail {

namespace {

Specialization constantsOf(const TargetInfo& info) {
  Specialization constants;
  constants.format = info.nodeFormat;
  constants.samples = info.samples;
  constants.nearestIsOne = info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? VK_TRUE : VK_FALSE;
  constants.maxLayers = info.maxLayers;
  constants.testDepth = info.testsDepth() ? VK_TRUE : VK_FALSE;
  return constants;
}

VkResult findComputePipeline(VitrailVkTarget_T& target, const Pass& pass, VkPipeline* pipeline) {
  const DeviceLimits& limits = target.context->limits;
  const bool byCompute = target.info.resolve == VITRAIL_RESOLVE_COMPUTE;
  ComputeKey key;
  key.kernel = pass.kernel;
  key.color = target.colorFormat == VK_FORMAT_R32G32B32A32_SFLOAT ? ColorImage::Rgba32f : ColorImage::Rgba16f;
  key.multisampled = target.info.samples > 1;
  key.byAddress = limits.poolByAddress;
  key.networks = limits.networks && (limits.exchangesInGroups || !byCompute);
  key.constants = target.constants;
  if (pass.group != 0) key.constants.group = pass.group;
  // Only what writes a picture looks at depth and colour: the others are shared by more targets.
  if (pass.call != Call::Resolve) {
    key.constants.testDepth = VK_FALSE;
    key.color = ColorImage::Rgba16f;
    key.multisampled = false;
  }
  return computePipeline(*target.context, key, pipeline);
}

VkResult makeFragmentPipeline(VitrailVkTarget_T& target, const Pass& pass, VkPipeline* pipeline) {
  const DeviceLimits& limits = target.context->limits;
  FragmentInfo info;
  info.resolve = pass.action == Action::DrawPlain ? FragmentResolve::Plain
                                                  : fragmentResolve(target.info, limits.dualSourceBlending);
  info.byAddress = limits.poolByAddress;
  info.networks = limits.networks;
  info.constants = target.constants;
  info.scopeSamples =
      target.info.perPixel() ? VK_SAMPLE_COUNT_1_BIT : static_cast<VkSampleCountFlagBits>(target.info.samples);
  info.colorFormat = target.colorFormat;
  info.scope = target.scope;
  const VkResult result = createFragmentPipeline(*target.context, info, pipeline);
  if (result == VK_SUCCESS) target.graphicsPipelines.push_back(*pipeline);
  return result;
}

VkResult findPipelines(VitrailVkTarget_T& target) {
  for (const Pass& pass : target.plan.passes()) {
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;
    if (pass.action == Action::Dispatch) result = findComputePipeline(target, pass, &pipeline);
    if (pass.action == Action::Draw || pass.action == Action::DrawPlain) {
      result = makeFragmentPipeline(target, pass, &pipeline);
    }
    if (result != VK_SUCCESS) return result;
    target.pipelines.push_back(pipeline);
  }
  return VK_SUCCESS;
}

VkResult createStats(VitrailVkTarget_T& target) {
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  const VkResult result = target.stats.create(
      *target.context, statisticsBytes(target.info.framesInFlight), VK_BUFFER_USAGE_TRANSFER_DST_BIT, kHost,
      VK_MEMORY_PROPERTY_HOST_CACHED_BIT, target.debugName.c_str(), "statistics");
  if (result != VK_SUCCESS) return result;
  for (StatsSlot& slot : target.slots()) new (&slot) StatsSlot{};
  return VK_SUCCESS;
}

// Copies what the host gave of an array of views.
const VkImageView* keep(const VkImageView* given, std::uint32_t count,
                        std::array<VkImageView, VITRAIL_MAX_VIEWS>& kept) {
  if (given == nullptr || count == 0) return nullptr;
  std::copy(given, given + count, kept.begin());
  return kept.data();
}

} // namespace

void keepViews(VitrailVkTarget_T& target, const VitrailVkViews& views) {
  target.views.count = views.count;
  target.views.color = keep(views.color, views.count, target.colorViews);
  target.views.opaque = keep(views.opaque, views.count, target.opaqueViews);
  target.views.depth = keep(views.depth, views.count, target.depthViews);
}

VkResult buildTarget(VitrailVkTarget_T& target) {
  target.constants = constantsOf(target.info);
  target.plan = FramePlan(planFacts(target.context->limits, target.info));
  VkResult result = findPipelines(target);
  if (result == VK_SUCCESS) result = createStats(target);
  if (result != VK_SUCCESS) return result;
  return replaceStorage(target, storageNeeds(target.context->limits, target.info), target.views);
}

VkResult replaceStorage(VitrailVkTarget_T& target, const StorageNeeds& needs, const VitrailVkViews& views) {
  StorageInfo info;
  info.needs = needs;
  info.buffer = target.hostBuffer;
  info.bufferOffset = target.info.bufferOffset;
  info.views = views;
  info.debugName = target.debugName.c_str();
  Storage made;
  const VkResult result = made.create(*target.context, info);
  if (result != VK_SUCCESS) {
    made.destroy(*target.context);
    return result;
  }
  if (target.storage.buffer != VK_NULL_HANDLE) target.retired.push_back(target.storage);
  target.storage = made;
  target.sums.reset();
  return VK_SUCCESS;
}

void freeRetired(VitrailVkTarget_T& target, std::uint64_t place) {
  std::erase_if(target.retired, [&](Storage& storage) {
    if (!storage.use.isFree(place, target.info.framesInFlight)) return false;
    storage.destroy(*target.context);
    return true;
  });
}

} // namespace vitrail
