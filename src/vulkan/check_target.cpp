#include "check_target.h"

#include <algorithm>

#include "core/pool.h"
#include "target.h"

namespace vitrail {

namespace {

constexpr std::uint32_t kDefaultFramesInFlight = 2;
// Where only a budget is given the pool starts with room for so many layers on every pixel, and grows.
constexpr std::uint64_t kFirstLayers = 2;

unsigned long long print(std::uint64_t value) { return value; }

double mebibytes(std::uint64_t bytes) { return static_cast<double>(bytes) / (1024.0 * 1024.0); }

VkResult checkFormat(const VitrailContext_T& context, const VitrailTargetDesc& desc) {
  const Log& log = context.log;
  if (nodeBytes(desc.nodeFormat) == 0) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "nodeFormat %d is none of VitrailNodeFormat", desc.nodeFormat);
  }
  const int samples = desc.samples;
  if (samples != 1 && samples != 2 && samples != 4 && samples != 8) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "samples %d: 1, 2, 4 or 8 are possible", samples);
  }
  if ((context.limits.sampleCounts & desc.samples) == 0) {
    return log.fail(VK_ERROR_FEATURE_NOT_PRESENT, "this device renders no %d samples a pixel", samples);
  }
  if (maxNodeIndexCount(desc.nodeFormat, desc.samples) == 0) {
    return log.fail(VK_ERROR_FORMAT_NOT_SUPPORTED,
                    "compact nodes hold the coverage of up to 4 samples: use another node format for %d", samples);
  }
  return VK_SUCCESS;
}

VkResult checkResolve(const VitrailContext_T& context, const VitrailTargetDesc& desc) {
  const Log& log = context.log;
  const bool perSample = desc.samples > 1 && desc.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  if (desc.resolve != VITRAIL_RESOLVE_COMPUTE && desc.resolve != VITRAIL_RESOLVE_FRAGMENT) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "resolve %d is none of VitrailResolve", desc.resolve);
  }
  if (perSample && desc.resolve == VITRAIL_RESOLVE_COMPUTE) {
    return log.fail(VK_ERROR_FEATURE_NOT_PRESENT,
                    "a compute resolve writes one colour a pixel: resolve per sample with VITRAIL_RESOLVE_FRAGMENT");
  }
  if (perSample && !context.has(VITRAIL_FEATURE_SAMPLE_RATE_SHADING)) {
    return log.fail(VK_ERROR_FEATURE_NOT_PRESENT,
                    "a resolve per sample needs sampleRateShading: enable it and say so in VitrailContextDesc");
  }
  if (desc.resolve == VITRAIL_RESOLVE_FRAGMENT && desc.scope.stencilMark != VK_FALSE) {
    if (desc.scope.renderPass == VK_NULL_HANDLE && desc.scope.stencilFormat == VK_FORMAT_UNDEFINED) {
      return log.fail(VK_ERROR_INITIALIZATION_FAILED, "the stencil mark needs a stencilFormat in the scope");
    }
    if (desc.samples > 1 && !perSample) {
      return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                      "the stencil mark has as many samples as the collect pass: resolve per sample to use it");
    }
  }
  return VK_SUCCESS;
}

VkResult checkColorFormat(const VitrailContext_T& context, const VitrailTargetDesc& desc) {
  const bool compute = desc.resolve == VITRAIL_RESOLVE_COMPUTE;
  if (compute && desc.colorFormat != VK_FORMAT_R16G16B16A16_SFLOAT &&
      desc.colorFormat != VK_FORMAT_R32G32B32A32_SFLOAT) {
    return context.log.fail(VK_ERROR_FORMAT_NOT_SUPPORTED,
                            "colorFormat %d: a compute resolve writes VK_FORMAT_R16G16B16A16_SFLOAT or "
                            "VK_FORMAT_R32G32B32A32_SFLOAT",
                            desc.colorFormat);
  }
  const VkFormatFeatureFlags needed =
      compute ? VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT : VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
  VkFormatProperties properties{};
  context.vk.GetPhysicalDeviceFormatProperties(context.physicalDevice, desc.colorFormat, &properties);
  if ((properties.optimalTilingFeatures & needed) == 0) {
    return context.log.fail(VK_ERROR_FORMAT_NOT_SUPPORTED, "colorFormat %d: this device cannot use it as %s",
                            desc.colorFormat, compute ? "storage image" : "blended attachment");
  }
  return VK_SUCCESS;
}

} // namespace

VitrailTargetDesc withAreaPixels(const VitrailTargetDesc& desc) {
  VitrailTargetDesc full = desc;
  const std::uint64_t pixels = std::uint64_t{full.extent.width} * full.extent.height;
  if (full.areaPixels == 0 || full.areaPixels > pixels) {
    full.areaPixels = static_cast<std::uint32_t>(std::min<std::uint64_t>(pixels, ~0U));
  }
  return full;
}

VitrailTargetDesc withDefaults(VitrailContext context, const VitrailTargetDesc& desc) {
  VitrailTargetDesc full = withAreaPixels(desc);
  if (full.samples == 0) full.samples = VK_SAMPLE_COUNT_1_BIT;
  if (full.colorFormat == VK_FORMAT_UNDEFINED) full.colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  if (full.framesInFlight == 0) full.framesInFlight = kDefaultFramesInFlight;
  if (full.debugName == nullptr) full.debugName = "vitrail";
  if (full.resolve == VITRAIL_RESOLVE_DEFAULT) full.resolve = vitrailDefaultResolve(context, &full);
  if (full.linking == VITRAIL_LINKING_DEFAULT) full.linking = vitrailDefaultLinking(context, &full);
  if (full.memoryBudget != 0 && full.nodeCapacity == 0) {
    full.nodeCapacity = static_cast<std::uint32_t>(std::min<std::uint64_t>(kFirstLayers * full.areaPixels, ~0U));
  }
  return full;
}

bool keepsSums(const VitrailTargetDesc& desc) { return desc.overflow == VITRAIL_OVERFLOW_APPROXIMATE; }

VkDeviceSize statsBytes(const VitrailTargetDesc& desc) { return desc.framesInFlight * sizeof(StatsSlot); }

std::uint32_t budgetCapacity(VitrailContext context, const VitrailTargetDesc& desc, std::uint32_t areaPixels) {
  const std::uint64_t bytes = std::min({desc.memoryBudget - std::min(desc.memoryBudget, statsBytes(desc)),
                                        context->limits.allocationSize, context->limits.heapSize});
  const std::uint32_t fits =
      nodeCapacityFor(bytes, areaPixels, desc.nodeFormat, desc.samples, keepsSums(desc), context->limits.alignment);
  return std::min(fits, vitrailMaxNodeCapacity(context, desc.nodeFormat, desc.samples));
}

VkResult checkMemory(VitrailContext context, const VitrailTargetDesc& desc) {
  const Log& log = context->log;
  if (desc.extent.width == 0 || desc.extent.height == 0) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "extent %ux%u: both sides must be at least 1", desc.extent.width,
                    desc.extent.height);
  }
  const VkResult result = checkFormat(*context, desc);
  if (result != VK_SUCCESS) return result;
  if (desc.overflow != VITRAIL_OVERFLOW_APPROXIMATE && desc.overflow != VITRAIL_OVERFLOW_SKIP) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "overflow %d is none of VitrailOverflow", desc.overflow);
  }
  if (desc.linking != VITRAIL_LINKING_FRAGMENT && desc.linking != VITRAIL_LINKING_COMPUTE) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "linking %d is none of VitrailLinking", desc.linking);
  }
  static_assert(VITRAIL_MAX_PIXELS_LINKED_BY_COMPUTE == layout::VITRAIL_LOOSE_PIXELS);
  if (desc.linking == VITRAIL_LINKING_COMPUTE && desc.areaPixels > VITRAIL_MAX_PIXELS_LINKED_BY_COMPUTE) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "an area of %u pixels: VITRAIL_LINKING_COMPUTE takes up to %u at once; make the target with "
                    "VITRAIL_LINKING_FRAGMENT, or draw in tiles",
                    desc.areaPixels, layout::VITRAIL_LOOSE_PIXELS);
  }
  const std::uint64_t perPixel =
      std::max<std::uint64_t>(headBytes(desc.areaPixels), keepsSums(desc) ? sumBytes(desc.areaPixels) : 0);
  if (perPixel > context->limits.storageBufferRange) {
    return log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY,
                    "an area of %u pixels needs %.1f MiB in one binding, this device binds %.1f MiB: draw in tiles, or "
                    "with VITRAIL_OVERFLOW_SKIP",
                    desc.areaPixels, mebibytes(perPixel), mebibytes(context->limits.storageBufferRange));
  }
  if (desc.memoryBudget != 0 && budgetCapacity(context, desc, desc.areaPixels) == 0) {
    const StorageLayout least =
        layoutStorage(desc.areaPixels, 1, desc.nodeFormat, keepsSums(desc), context->limits.alignment);
    return log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY,
                    "memoryBudget %llu: the head pointers alone need %llu bytes; raise it, or draw in tiles",
                    print(desc.memoryBudget), print(least.total + statsBytes(desc)));
  }
  if (desc.memoryBudget != 0) return VK_SUCCESS; // the capacity follows it
  const std::uint32_t most = vitrailMaxNodeCapacity(context, desc.nodeFormat, desc.samples);
  if (desc.nodeCapacity > most) {
    return log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY, "nodeCapacity %u: this device holds at most %u nodes in one pool",
                    desc.nodeCapacity, most);
  }
  const StorageLayout storage =
      layoutStorage(desc.areaPixels, desc.nodeCapacity, desc.nodeFormat, keepsSums(desc), context->limits.alignment);
  const std::uint64_t largest = std::min(context->limits.allocationSize, context->limits.heapSize);
  if (storage.total > largest) {
    return log.fail(VK_ERROR_OUT_OF_DEVICE_MEMORY, "%.1f MiB of fragment lists: this device allocates at most %.1f MiB",
                    mebibytes(storage.total), mebibytes(largest));
  }
  return VK_SUCCESS;
}

VkResult checkViews(VitrailContext context, const VitrailTargetDesc& desc, const VitrailViews& views) {
  const Log& log = context->log;
  if (views.count > VITRAIL_MAX_COLOR_VIEWS) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "%u views: at most %d", views.count, VITRAIL_MAX_COLOR_VIEWS);
  }
  const bool perSample = desc.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  const auto missing = [&](const VkImageView* given) { return views.count == 0 || given == nullptr; };
  if (desc.resolve == VITRAIL_RESOLVE_COMPUTE && missing(views.color)) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "a compute resolve needs views.color to write to");
  }
  if (desc.samples > 1 && !perSample && missing(views.opaque)) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "a resolve of %d samples per pixel needs views.opaque to read",
                    static_cast<int>(desc.samples));
  }
  if (desc.samples > 1 && desc.postDepthCoverage == VK_FALSE && missing(views.depth)) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "%d samples without postDepthCoverage need views.depth to test against",
                    static_cast<int>(desc.samples));
  }
  return VK_SUCCESS;
}

VkResult checkTarget(VitrailContext context, const VitrailTargetDesc& desc) {
  const Log& log = context->log;
  VkResult result = checkMemory(context, desc);
  if (result == VK_SUCCESS) result = checkResolve(*context, desc);
  if (result == VK_SUCCESS) result = checkColorFormat(*context, desc);
  if (result == VK_SUCCESS) result = checkViews(context, desc, desc.views);
  if (result != VK_SUCCESS) return result;
  if (desc.depthOrder != VITRAIL_DEPTH_NEAREST_IS_ZERO && desc.depthOrder != VITRAIL_DEPTH_NEAREST_IS_ONE) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "depthOrder %d is none of VitrailDepthOrder", desc.depthOrder);
  }
  if (desc.framesInFlight > VITRAIL_MAX_FRAMES_IN_FLIGHT) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "framesInFlight %u: at most %d", desc.framesInFlight,
                    VITRAIL_MAX_FRAMES_IN_FLIGHT);
  }
  if (desc.buffer == VK_NULL_HANDLE) return VK_SUCCESS;
  if (desc.memoryBudget != 0) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "memoryBudget and buffer exclude each other: a pool in the host's memory does not grow");
  }
  if (desc.bufferOffset % context->limits.alignment != 0) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "bufferOffset %llu is not a multiple of %llu",
                    print(desc.bufferOffset), print(context->limits.alignment));
  }
  return VK_SUCCESS;
}

} // namespace vitrail
