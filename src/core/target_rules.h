// The rules of a target's descriptor that no graphics API owns: what a field's zero stands for, what goes with what,
// what fits into memory.
#pragma once

#include <cstdint>

#include "device_limits.h"
#include "log.h"
#include "pool.h"
#include "vitrail/tiles.h"
#include "vitrail/types.h"

namespace vitrail {

// A target's descriptor without what depends on an API: fields as in VitrailVkTargetDesc.
struct TargetInfo {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 0;
  VitrailNodeFormat nodeFormat = VITRAIL_NODE_STANDARD;
  VitrailDepthOrder depthOrder = VITRAIL_DEPTH_NEAREST_IS_ZERO;
  VitrailResolve resolve = VITRAIL_RESOLVE_DEFAULT;
  VitrailMsaaResolve msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  bool postDepthCoverage = false;
  std::uint32_t maxLayers = 0;
  VitrailOverflow overflow = VITRAIL_OVERFLOW_APPROXIMATE;
  VitrailListBuild listBuild = VITRAIL_LIST_BUILD_DEFAULT;
  bool userWords = false;
  std::uint32_t nodeCapacity = 0;
  std::uint64_t memoryBudget = 0;
  std::uint32_t areaPixels = 0;
  std::uint32_t copyLayers = 0;
  bool ownBuffer = false; // the host brings the memory
  std::uint64_t bufferOffset = 0;
  std::uint64_t bufferSize = 0;
  std::uint32_t framesInFlight = 0;
  bool canStoreColor = false; // compute shaders can write the colour's format, and a view to write is given
  bool stencilMark = false;
  bool hasStencil = false; // the scope has one, or may have

  [[nodiscard]] bool hostResolves() const { return resolve == VITRAIL_RESOLVE_HOST; }
  [[nodiscard]] bool keepsSums() const { return overflow == VITRAIL_OVERFLOW_APPROXIMATE && !hostResolves(); }
  // How the library's own resolve takes several samples.
  [[nodiscard]] bool perSample() const { return severalResolved() && msaaResolve == VITRAIL_MSAA_RESOLVE_PER_SAMPLE; }
  [[nodiscard]] bool perPixel() const { return severalResolved() && msaaResolve != VITRAIL_MSAA_RESOLVE_PER_SAMPLE; }
  // Coverage has not passed the depth test: the resolve tests it.
  [[nodiscard]] bool testsDepth() const { return severalResolved() && !postDepthCoverage; }

 private:
  [[nodiscard]] bool severalResolved() const { return samples > 1 && !hostResolves(); }
};

// What images the host gives, each kind with as many views as `count` says.
struct ViewsInfo {
  const char* field = "views"; // the descriptor's, for messages
  std::uint32_t count = 0;
  bool color = false;
  bool opaque = false;
  bool depth = false;
  const char* nullName = nullptr; // the first array that holds a null handle, and where
  std::uint32_t nullIndex = 0;
};

// What DEFAULT stands for.
VitrailResolve defaultResolve(const TargetInfo& info);
VitrailListBuild defaultListBuild(const DeviceLimits& limits, const TargetInfo& info);

// The target with its defaults filled in.
TargetInfo withDefaults(const DeviceLimits& limits, TargetInfo info);

// These log the reason where they fail. `info` has its defaults.
// What concerns memory: extent, samples, node format, overflow, list build, area, capacity, budget, the host's buffer.
VitrailResult checkMemory(const DeviceLimits& limits, const Log& log, const TargetInfo& info);
// Everything, and the views.
VitrailResult checkTarget(const DeviceLimits& limits, const Log& log, const TargetInfo& info);
VitrailResult checkViews(const Log& log, const TargetInfo& info, const ViewsInfo& views);

// The memory that a target with its defaults needs.
StorageNeeds storageNeeds(const DeviceLimits& limits, const TargetInfo& info);

// The most nodes that one pool can have on a device; 0 where the format is none, or not at that sample count.
std::uint32_t maxNodeCapacity(const DeviceLimits& limits, std::uint32_t format, std::uint32_t samples, bool userWords);

// What a device can hold of such nodes, for plans of tiles; `next` stays. Logs the reason where it fails.
VitrailResult tileLimits(const DeviceLimits& limits, const Log& log, std::uint32_t format, std::uint32_t samples,
                         VitrailTileLimits& tiles);

// The nodes that the budget has room for, at most as many as a pool can have.
std::uint32_t budgetCapacity(const DeviceLimits& limits, const TargetInfo& info);

// The same for what the host asks for: within the budget, where there is one.
std::uint32_t capacityWithin(const DeviceLimits& limits, const TargetInfo& info);

// The target after a resize; nodeCapacity and areaPixels 0: as vitrailVkResizeTarget says. `present`: the pool's nodes.
TargetInfo resized(const TargetInfo& info, std::uint32_t present, std::uint32_t width, std::uint32_t height,
                   std::uint32_t nodeCapacity, std::uint32_t areaPixels);

} // namespace vitrail
