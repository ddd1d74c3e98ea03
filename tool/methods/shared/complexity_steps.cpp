#include "complexity_steps.h"

#include <algorithm>

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kItemsPerGroup = 2 * shaders::COMPLEXITY_GROUP;

std::uint32_t groupsOf(std::uint32_t items) { return (items + kItemsPerGroup - 1) / kItemsPerGroup; }

} // namespace

std::uint64_t complexityParts(std::uint32_t pixels) {
  std::uint64_t parts = 1;
  for (std::uint32_t groups = groupsOf(pixels); groups > 1; groups = groupsOf(groups)) parts += groups;
  return parts;
}

std::vector<ComplexityStep> complexitySteps(std::uint32_t width, std::uint32_t height, std::uint32_t source,
                                            std::uint32_t nearest) {
  std::vector<ComplexityStep> steps;
  shaders::ComplexityReduction step{.source = source,
                                    .count = width * height,
                                    .width = width,
                                    .from = 0,
                                    .to = 1,
                                    .nearest = nearest > 0 ? nearest : UINT32_MAX};
  for (bool last = false; !last;) {
    const std::uint32_t groups = groupsOf(step.count);
    last = groups == 1;
    const std::uint32_t next = step.to;
    if (last) step.to = 0;
    const std::uint32_t row = std::min(groups, shaders::COMPLEXITY_ROW);
    steps.push_back({step, row, (groups + row - 1) / row});
    step.source = shaders::COMPLEXITY_PARTS;
    step.count = groups;
    step.from = next;
    step.to = next + groups;
  }
  return steps;
}

FrameStats complexityStats(const shaders::Complexity& measured) {
  const auto wide = [](std::uint32_t low, std::uint32_t high) { return std::uint64_t{high} << 32 | low; };
  FrameStats stats;
  stats.counted = true;
  stats.fragmentsRequested = wide(measured.surfacesLow, measured.surfacesHigh);
  stats.fragmentsStored = wide(measured.keptLow, measured.keptHigh);
  stats.fragmentsMissing = stats.fragmentsRequested - stats.fragmentsStored;
  stats.complete = stats.fragmentsMissing == 0;
  stats.approximatePixels = measured.deeperPixels;
  stats.layersMax = measured.deepest;
  stats.layersMean = meanLayers(stats.fragmentsStored, measured.coveredPixels);
  return stats;
}

} // namespace vitrail::tool
