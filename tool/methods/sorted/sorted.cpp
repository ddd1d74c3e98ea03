#include "sorted.h"

#include <algorithm>
#include <utility>

#include "../shared/camera_distance.h"
#include "../shared/fixed_blending.h"
#include "../shared/host_clock.h"

namespace vitrail::tool {

Sorted::Sorted(const MethodHost& host, const MethodOptions& options)
    : surfaces_(makeBlendedSurfaces(host, options, "sorted")) {
  for (const PlacedBox& placed : host.surfaces.scene().transparentBoxes()) {
    const glm::dvec3 middle = 0.5 * (glm::dvec3(placed.box.min) + glm::dvec3(placed.box.max));
    middles_.emplace_back(glm::dmat4(placed.model) * glm::dvec4(middle, 1.0));
  }
}

// The farthest first; equal distances in the order of submission.
std::vector<SurfaceRun> Sorted::sortedRuns(const Surfaces& surfaces) const {
  std::vector<std::pair<double, SurfaceRun>> order;
  order.reserve(middles_.size());
  for (const SurfaceRun& run : surfaces.transparentRuns()) {
    order.emplace_back(distanceFromCamera(surfaces.view(), middles_[run.draw]), run);
  }
  std::ranges::stable_sort(order, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<SurfaceRun> runs;
  runs.reserve(order.size());
  for (const auto& [distance, run] : order) runs.push_back(run);
  return runs;
}

void Sorted::draw(Frame& frame) {
  const HostClock clock;
  const std::vector<SurfaceRun> runs = sortedRuns(frame.surfaces());
  frame.addHostPass("sort", clock.milliseconds());
  cmdBeginBlending(frame);
  frame.drawSurfaces(surfaces_, VK_NULL_HANDLE, runs);
  vkCmdEndRendering(frame.commands());
  frame.endPass("blend");
}

} // namespace vitrail::tool
