#include "parameters.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace vitrail {

layout::VitrailParameters parametersOf(const TargetInfo& info, std::uint32_t nodeCapacity, const PoolAccess& pool,
                                       const VitrailRect& area, std::uint64_t frame) {
  layout::VitrailParameters parameters{};
  parameters.x = area.x;
  parameters.y = area.y;
  parameters.width = area.width;
  parameters.height = area.height;
  parameters.capacity = nodeCapacity;
  parameters.format = info.nodeFormat;
  parameters.samples = info.samples;
  parameters.nearestIsOne = info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? 1 : 0;
  parameters.keepSums = info.keepsSums() ? 1 : 0;
  parameters.loose = info.listBuild == VITRAIL_LIST_BUILD_COMPUTE ? 1 : 0;
  parameters.nodesLow = static_cast<std::uint32_t>(pool.address);
  parameters.nodesHigh = static_cast<std::uint32_t>(pool.address >> 32U);
  parameters.wholeByBinding = pool.wholeByBinding ? 1 : 0;
  parameters.wholeByAddress = pool.address != 0 ? 1 : 0;
  parameters.userWords = info.userWords ? 1 : 0;
  parameters.frame = static_cast<std::uint32_t>(frame);
  std::array<std::uint32_t, VITRAIL_LAYOUTS> capacities{};
  static_assert(sizeof(capacities) == sizeof(parameters.capacities));
  const auto suit = [&](std::uint32_t byAddress, std::uint32_t postDepth) {
    capacities.at(VITRAIL_LAYOUT(parameters.format, parameters.samples, parameters.keepSums, parameters.loose,
                                 parameters.userWords, byAddress, postDepth)) = parameters.capacity;
  };
  for (const std::uint32_t postDepth : {0U, 1U}) {
    // Coverage that has passed the depth test may be tested again; one that has not must not go untested.
    if (postDepth == 0 && info.samples > 1 && info.postDepthCoverage) continue;
    if (pool.wholeByBinding) suit(0, postDepth);
    if (pool.address != 0) suit(1, postDepth);
  }
  std::memcpy(parameters.capacities, capacities.data(), sizeof(capacities));
  return parameters;
}

VitrailRect areaOfFrame(const TargetInfo& info, const Log& log, std::int64_t x, std::int64_t y, std::uint32_t width,
                        std::uint32_t height, bool& whole) {
  VitrailRect area{0, 0, info.width, info.height};
  if (width != 0 && height != 0) {
    const std::int64_t left = std::clamp<std::int64_t>(x, 0, info.width);
    const std::int64_t top = std::clamp<std::int64_t>(y, 0, info.height);
    const std::int64_t right = std::clamp<std::int64_t>(x + width, left, info.width);
    const std::int64_t bottom = std::clamp<std::int64_t>(y + height, top, info.height);
    area = {static_cast<std::uint32_t>(left), static_cast<std::uint32_t>(top), static_cast<std::uint32_t>(right - left),
            static_cast<std::uint32_t>(bottom - top)};
    if (area.width != width || area.height != height) {
      log.warn("an area of %ux%u pixels at %lld,%lld is begun, the target has %ux%u: what is outside is left out",
               width, height, static_cast<long long>(x), static_cast<long long>(y), info.width, info.height);
    }
    if (area.width == 0 || area.height == 0) return {area.x, area.y, 0, 0};
  }
  if (std::uint64_t{area.width} * area.height > info.areaPixels) {
    log.warn("an area of %ux%u pixels is begun, the target has areaPixels %u: the rest is left out", area.width,
             area.height, info.areaPixels);
    whole = false;
    area.width = std::min(area.width, info.areaPixels);
    area.height = info.areaPixels / area.width;
  }
  return area;
}

} // namespace vitrail
