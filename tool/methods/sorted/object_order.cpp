#include "object_order.h"

#include <algorithm>
#include <utility>

#include "../shared/camera_distance.h"

namespace vitrail::tool {

ObjectOrder::ObjectOrder(const SceneDraws& draws, const Scene& scene) {
  for (std::uint32_t d = 0; d < draws.transparentDraws().size(); ++d) {
    const GpuDraw& draw = draws.transparentDraws()[d];
    const Bounds box = boundsOf(scene.meshes[draw.mesh]);
    const glm::dvec3 middle = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
    for (std::uint32_t i = draw.firstInstance; i < draw.firstInstance + draw.instanceCount; ++i) {
      middles_.emplace_back(glm::dmat4(draws.placeOf(scene, i)) * glm::dvec4(middle, 1.0));
      runs_.push_back({d, draw.firstIndex, draw.indexCount, i, 1});
    }
  }
}

std::vector<SurfaceRun> ObjectOrder::farthestFirst(const shaders::FrameData& view) const {
  std::vector<std::pair<double, SurfaceRun>> order;
  order.reserve(middles_.size());
  for (std::size_t i = 0; i < runs_.size(); ++i) order.emplace_back(distanceFromCamera(view, middles_[i]), runs_[i]);
  std::ranges::stable_sort(order, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<SurfaceRun> runs;
  runs.reserve(order.size());
  for (const auto& [distance, run] : order) runs.push_back(run);
  return runs;
}

} // namespace vitrail::tool
