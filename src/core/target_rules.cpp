#include "target_rules.h"

#include <algorithm>

#include "growth.h"
#include "statistics.h"

namespace vitrail {

namespace {

constexpr std::uint32_t kDefaultFramesInFlight = 2;
// Where only a budget is given the pool starts with room for so many layers on every pixel, and grows.
constexpr std::uint64_t kFirstLayers = 2;
constexpr std::uint64_t kMost32 = 0xffffffffU;

static_assert(VITRAIL_LIST_BUILD_COMPUTE_MAX_PIXELS == layout::VITRAIL_LOOSE_PIXELS);

unsigned long long print(std::uint64_t value) { return value; }

double mebibytes(std::uint64_t bytes) { return static_cast<double>(bytes) / (1024.0 * 1024.0); }

std::uint32_t areaOf(std::uint32_t areaPixels, std::uint32_t width, std::uint32_t height) {
  const std::uint64_t pixels = std::min(std::uint64_t{width} * height, kMost32);
  return areaPixels == 0 || areaPixels > pixels ? static_cast<std::uint32_t>(pixels) : areaPixels;
}

VitrailResult unknown(const Log& log, const char* field, int value, const char* type) {
  return log.fail(VITRAIL_ERROR_INVALID, "%s %d is none of %s", field, value, type);
}

VitrailResult checkFormat(const DeviceLimits& limits, const Log& log, const TargetInfo& info) {
  if (nodeBytes(info.nodeFormat) == 0) return unknown(log, "nodeFormat", info.nodeFormat, "VitrailNodeFormat");
  if (info.samples != 1 && info.samples != 2 && info.samples != 4 && info.samples != 8) {
    return log.fail(VITRAIL_ERROR_INVALID, "samples %u: 1, 2, 4 or 8 are possible", info.samples);
  }
  if ((limits.sampleCounts & info.samples) == 0) {
    return log.fail(VITRAIL_ERROR_UNSUPPORTED, "this device renders no %u samples a pixel", info.samples);
  }
  if (maxNodeIndexCount(info.nodeFormat, info.samples) == 0) {
    return log.fail(VITRAIL_ERROR_FORMAT,
                    "compact nodes hold the coverage of up to 4 samples: use another node format for %u", info.samples);
  }
  return VITRAIL_SUCCESS;
}

VitrailResult checkListBuild(const Log& log, const TargetInfo& info) {
  if (info.listBuild != VITRAIL_LIST_BUILD_FRAGMENT && info.listBuild != VITRAIL_LIST_BUILD_COMPUTE) {
    return unknown(log, "listBuild", info.listBuild, "VitrailListBuild");
  }
  if (info.listBuild == VITRAIL_LIST_BUILD_COMPUTE && info.areaPixels > VITRAIL_LIST_BUILD_COMPUTE_MAX_PIXELS) {
    return log.fail(VITRAIL_ERROR_INVALID,
                    "an area of %u pixels: VITRAIL_LIST_BUILD_COMPUTE takes up to %u at once; make the target with "
                    "VITRAIL_LIST_BUILD_FRAGMENT, or draw in tiles",
                    info.areaPixels, VITRAIL_LIST_BUILD_COMPUTE_MAX_PIXELS);
  }
  return VITRAIL_SUCCESS;
}

// What shaders reach through one binding, whatever the pool.
VitrailResult checkBindings(const DeviceLimits& limits, const Log& log, const TargetInfo& info) {
  const std::uint64_t perPixel =
      std::max<std::uint64_t>(headBytes(info.areaPixels), info.keepsSums() ? sumBytes(info.areaPixels) : 0);
  if (perPixel > limits.storageBufferRange) {
    return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY,
                    "an area of %u pixels needs %.1f MiB in one binding, this device binds %.1f MiB: draw in tiles, or "
                    "with VITRAIL_OVERFLOW_SKIP",
                    info.areaPixels, mebibytes(perPixel), mebibytes(limits.storageBufferRange));
  }
  const std::uint64_t copy = copyBytes(info.copyLayers, info.copyLayers);
  if (info.copyLayers > 0 && copy > limits.storageBufferRange) {
    return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY,
                    "copyLayers %u needs %.1f MiB in one binding, this device binds %.1f MiB: copy smaller areas",
                    info.copyLayers, mebibytes(copy), mebibytes(limits.storageBufferRange));
  }
  return VITRAIL_SUCCESS;
}

VitrailResult checkBudget(const DeviceLimits& limits, const Log& log, const TargetInfo& info) {
  if (budgetCapacity(limits, info) != 0) return VITRAIL_SUCCESS; // the capacity follows it
  StorageNeeds least = storageNeeds(limits, info);
  least.nodeCapacity = 1;
  return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY,
                  "memoryBudget %llu: the head pointers alone need %llu bytes; raise it, or draw in tiles",
                  print(info.memoryBudget), print(layoutStorage(least).total + statisticsBytes(info.framesInFlight)));
}

VitrailResult checkCapacity(const DeviceLimits& limits, const Log& log, const TargetInfo& info) {
  if (info.nodeCapacity == 0) {
    return log.fail(
        VITRAIL_ERROR_INVALID,
        "nodeCapacity and memoryBudget are both 0: say how many fragments the pool holds, or the bytes that it "
        "may grow to");
  }
  const std::uint32_t most = maxNodeCapacity(limits, info.nodeFormat, info.samples, info.userWords);
  if (info.nodeCapacity > most) {
    return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "nodeCapacity %u: this device holds at most %u nodes in one pool",
                    info.nodeCapacity, most);
  }
  const std::uint64_t total = layoutStorage(storageNeeds(limits, info)).total;
  const std::uint64_t largest = std::min(limits.allocationSize, limits.heapSize);
  if (total > largest) {
    return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "%.1f MiB of fragment lists: this device allocates at most %.1f MiB",
                    mebibytes(total), mebibytes(largest));
  }
  return VITRAIL_SUCCESS;
}

VitrailResult checkResolve(const DeviceLimits& limits, const Log& log, const TargetInfo& info) {
  if (info.resolve != VITRAIL_RESOLVE_COMPUTE && info.resolve != VITRAIL_RESOLVE_FRAGMENT && !info.hostResolves()) {
    return unknown(log, "resolve", info.resolve, "VitrailResolve");
  }
  if (info.hostResolves() && info.maxLayers != 0) {
    return log.fail(VITRAIL_ERROR_INVALID,
                    "maxLayers %u with VITRAIL_RESOLVE_HOST: bound the layers where you walk the lists",
                    info.maxLayers);
  }
  if (info.msaaResolve != VITRAIL_MSAA_RESOLVE_PER_PIXEL && info.msaaResolve != VITRAIL_MSAA_RESOLVE_PER_SAMPLE) {
    return unknown(log, "msaaResolve", info.msaaResolve, "VitrailMsaaResolve");
  }
  if (info.perSample() && info.resolve == VITRAIL_RESOLVE_COMPUTE) {
    return log.fail(VITRAIL_ERROR_UNSUPPORTED,
                    "a compute resolve writes one colour a pixel: resolve per sample with VITRAIL_RESOLVE_FRAGMENT");
  }
  if (info.perSample() && !limits.sampleShading) {
    return log.fail(VITRAIL_ERROR_UNSUPPORTED,
                    "a resolve per sample needs sample shading: enable it and say so in the context's features");
  }
  if (info.resolve == VITRAIL_RESOLVE_FRAGMENT && info.stencilMark) {
    if (!info.hasStencil) {
      return log.fail(VITRAIL_ERROR_INVALID, "the stencil mark needs a stencilFormat in the scope");
    }
    if (info.perPixel()) {
      return log.fail(VITRAIL_ERROR_INVALID,
                      "the stencil mark has as many samples as the collect pass: resolve per sample to use it");
    }
  }
  return VITRAIL_SUCCESS;
}

VitrailResult checkBuffer(const DeviceLimits& limits, const Log& log, const TargetInfo& info) {
  if (info.memoryBudget != 0) {
    return log.fail(VITRAIL_ERROR_INVALID,
                    "memoryBudget and buffer exclude each other: a pool in the host's memory does not grow");
  }
  if (info.bufferOffset % limits.alignment != 0) {
    return log.fail(VITRAIL_ERROR_INVALID, "bufferOffset %llu is not a multiple of %llu", print(info.bufferOffset),
                    print(limits.alignment));
  }
  const std::uint64_t total = layoutStorage(storageNeeds(limits, info)).total;
  if (info.bufferSize < total) {
    return log.fail(VITRAIL_ERROR_INVALID, "bufferSize %llu: the target needs %llu bytes from bufferOffset on",
                    print(info.bufferSize), print(total));
  }
  return VITRAIL_SUCCESS;
}

} // namespace

VitrailResolve defaultResolve(const TargetInfo& info) {
  return info.canStoreColor && !info.perSample() ? VITRAIL_RESOLVE_COMPUTE : VITRAIL_RESOLVE_FRAGMENT;
}

VitrailListBuild defaultListBuild(const DeviceLimits& limits, const TargetInfo& info) {
  const bool fits = areaOf(info.areaPixels, info.width, info.height) <= VITRAIL_LIST_BUILD_COMPUTE_MAX_PIXELS;
  return fits && limits.fewFragmentCores ? VITRAIL_LIST_BUILD_COMPUTE : VITRAIL_LIST_BUILD_FRAGMENT;
}

TargetInfo withDefaults(const DeviceLimits& limits, TargetInfo info) {
  info.areaPixels = areaOf(info.areaPixels, info.width, info.height);
  if (info.samples == 0) info.samples = 1;
  if (info.framesInFlight == 0) info.framesInFlight = kDefaultFramesInFlight;
  if (info.resolve == VITRAIL_RESOLVE_DEFAULT) info.resolve = defaultResolve(info);
  if (info.listBuild == VITRAIL_LIST_BUILD_DEFAULT) info.listBuild = defaultListBuild(limits, info);
  if (info.memoryBudget != 0 && info.nodeCapacity == 0) {
    info.nodeCapacity = static_cast<std::uint32_t>(std::min(kFirstLayers * info.areaPixels, kMost32));
  }
  return info;
}

VitrailResult checkMemory(const DeviceLimits& limits, const Log& log, const TargetInfo& info) {
  if (info.width == 0 || info.height == 0) {
    return log.fail(VITRAIL_ERROR_INVALID, "extent %ux%u: both sides must be at least 1", info.width, info.height);
  }
  VitrailResult result = checkFormat(limits, log, info);
  if (result != VITRAIL_SUCCESS) return result;
  if (info.overflow != VITRAIL_OVERFLOW_APPROXIMATE && info.overflow != VITRAIL_OVERFLOW_SKIP) {
    return unknown(log, "overflow", info.overflow, "VitrailOverflow");
  }
  if (info.framesInFlight > VITRAIL_MAX_FRAMES_IN_FLIGHT) {
    return log.fail(VITRAIL_ERROR_INVALID, "framesInFlight %u: at most %d", info.framesInFlight,
                    VITRAIL_MAX_FRAMES_IN_FLIGHT);
  }
  result = checkListBuild(log, info);
  if (result == VITRAIL_SUCCESS) result = checkBindings(limits, log, info);
  if (result != VITRAIL_SUCCESS) return result;
  return info.memoryBudget != 0 ? checkBudget(limits, log, info) : checkCapacity(limits, log, info);
}

VitrailResult checkTarget(const DeviceLimits& limits, const Log& log, const TargetInfo& info) {
  VitrailResult result = checkMemory(limits, log, info);
  if (result == VITRAIL_SUCCESS) result = checkResolve(limits, log, info);
  if (result != VITRAIL_SUCCESS) return result;
  if (info.depthOrder != VITRAIL_DEPTH_NEAREST_IS_ZERO && info.depthOrder != VITRAIL_DEPTH_NEAREST_IS_ONE) {
    return unknown(log, "depthOrder", info.depthOrder, "VitrailDepthOrder");
  }
  return info.ownBuffer ? checkBuffer(limits, log, info) : VITRAIL_SUCCESS;
}

VitrailResult checkViews(const Log& log, const TargetInfo& info, const ViewsInfo& views) {
  if (views.count > VITRAIL_MAX_VIEWS) {
    return log.fail(VITRAIL_ERROR_INVALID, "%s.count %u: at most %d", views.field, views.count, VITRAIL_MAX_VIEWS);
  }
  if (views.count == 0 && (views.color || views.opaque || views.depth)) {
    return log.fail(VITRAIL_ERROR_INVALID, "%s.count is 0, and %s.%s is given: say how many views there are",
                    views.field, views.field,
                    views.color    ? "color"
                    : views.opaque ? "opaque"
                                   : "depth");
  }
  if (views.count != 0 && !views.color && !views.opaque && !views.depth) {
    return log.fail(VITRAIL_ERROR_INVALID, "%s.count is %u, and no array of views is given", views.field, views.count);
  }
  if (views.nullName != nullptr) {
    return log.fail(VITRAIL_ERROR_INVALID, "%s.%s[%u] is a null handle", views.field, views.nullName, views.nullIndex);
  }
  if (info.resolve == VITRAIL_RESOLVE_COMPUTE && !views.color) {
    return log.fail(VITRAIL_ERROR_INVALID, "a compute resolve needs %s.color to write to", views.field);
  }
  if (info.perPixel() && !views.opaque) {
    return log.fail(VITRAIL_ERROR_INVALID, "a resolve of %u samples per pixel needs %s.opaque to read", info.samples,
                    views.field);
  }
  if (info.testsDepth() && !views.depth) {
    return log.fail(VITRAIL_ERROR_INVALID, "%u samples without postDepthCoverage need %s.depth to test against",
                    info.samples, views.field);
  }
  return VITRAIL_SUCCESS;
}

StorageNeeds storageNeeds(const DeviceLimits& limits, const TargetInfo& info) {
  StorageNeeds needs;
  needs.areaPixels = info.areaPixels;
  needs.nodeCapacity = info.nodeCapacity;
  needs.format = info.nodeFormat;
  needs.keepSums = info.keepsSums();
  needs.userWords = info.userWords;
  needs.copyLayers = info.copyLayers;
  needs.alignment = limits.alignment;
  return needs;
}

std::uint32_t maxNodeCapacity(const DeviceLimits& limits, std::uint32_t format, std::uint32_t samples, bool userWords) {
  const std::uint32_t bytes = nodeBytes(format, userWords);
  if (bytes == 0) return 0;
  std::uint64_t most = std::min(limits.allocationSize, limits.heapSize);
  if (!limits.poolByAddress) most = std::min(most, limits.storageBufferRange);
  const std::uint64_t listed = nodesForGroupLists(limits.storageBufferRange);
  const std::uint32_t indices = maxNodeIndexCount(format, samples != 0 ? samples : 1);
  return static_cast<std::uint32_t>(std::min<std::uint64_t>({most / bytes, listed, indices}));
}

VitrailResult tileLimits(const DeviceLimits& limits, const Log& log, std::uint32_t format, std::uint32_t samples,
                         VitrailTileLimits& tiles) {
  if (nodeBytes(format) == 0) {
    return log.fail(VITRAIL_ERROR_INVALID, "nodeFormat %u is none of VitrailNodeFormat", format);
  }
  tiles.memoryBytes = std::min(limits.allocationSize, limits.heapSize);
  tiles.alignment = limits.alignment;
  tiles.nodeCapacity = maxNodeCapacity(limits, format, samples, false);
  tiles.areaPixels =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(limits.storageBufferRange / sizeof(layout::uint), kMost32));
  if (tiles.nodeCapacity == 0) {
    return log.fail(VITRAIL_ERROR_FORMAT, "nodeFormat %u has no nodes at %u samples", format, samples);
  }
  return VITRAIL_SUCCESS;
}

std::uint32_t budgetCapacity(const DeviceLimits& limits, const TargetInfo& info) {
  const std::uint64_t beside = statisticsBytes(info.framesInFlight);
  const std::uint64_t bytes =
      std::min({info.memoryBudget - std::min(info.memoryBudget, beside), limits.allocationSize, limits.heapSize});
  const std::uint32_t fits = nodeCapacityFor(bytes, storageNeeds(limits, info), info.samples);
  return std::min(fits, maxNodeCapacity(limits, info.nodeFormat, info.samples, info.userWords));
}

std::uint32_t capacityWithin(const DeviceLimits& limits, const TargetInfo& info) {
  return info.memoryBudget == 0 ? info.nodeCapacity : std::min(info.nodeCapacity, budgetCapacity(limits, info));
}

TargetInfo resized(const TargetInfo& info, std::uint32_t present, std::uint32_t width, std::uint32_t height,
                   std::uint32_t nodeCapacity, std::uint32_t areaPixels) {
  TargetInfo wanted = info;
  wanted.width = width;
  wanted.height = height;
  wanted.areaPixels = areaOf(areaPixels, width, height);
  wanted.nodeCapacity = nodeCapacity != 0 ? nodeCapacity : present;
  if (nodeCapacity == 0 && info.memoryBudget != 0) {
    // The same layers on every pixel: the first frames of the new size are as likely to fit as the last of the old.
    // What a pool has whatever its frames need is no part of that.
    const double layers = static_cast<double>(present - std::min(present, kSpareNodes)) / std::max(info.areaPixels, 1U);
    const double nodes = layers * wanted.areaPixels + std::min(present, kSpareNodes);
    wanted.nodeCapacity = static_cast<std::uint32_t>(std::clamp(nodes, 1.0, static_cast<double>(kMost32)));
  }
  return wanted;
}

} // namespace vitrail
