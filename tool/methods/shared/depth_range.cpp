#include "depth_range.h"

#include <algorithm>
#include <limits>

namespace vitrail::tool {

namespace {

constexpr double kNearest = 1e-4; // of the farthest depth, where surfaces reach the eye

} // namespace

DepthRange transparentDepths(const Surfaces& surfaces) {
  const shaders::FrameData& view = surfaces.view();
  const glm::dvec3 forward = -glm::dvec3(view.cameraToWorld[2]);
  double nearest = std::numeric_limits<double>::max();
  double farthest = std::numeric_limits<double>::lowest();
  for (const PlacedBox& placed : surfaces.scene().transparentBoxes()) {
    for (unsigned i = 0; i < 8; ++i) {
      const glm::vec3& low = placed.box.min;
      const glm::vec3& high = placed.box.max;
      const glm::dvec4 corner((i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y,
                              (i & 4U) != 0 ? high.z : low.z, 1.0);
      const double depth = glm::dot(glm::dvec3(glm::dmat4(placed.model) * corner) - glm::dvec3(view.eye), forward);
      nearest = std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
  }
  const bool perspective = view.eye.w < 0.5F;
  if (nearest > farthest || (perspective && farthest <= 0.0)) return {}; // nothing is seen
  if (perspective) nearest = std::max(nearest, kNearest * farthest);
  return {static_cast<float>(nearest), static_cast<float>(farthest)};
}

} // namespace vitrail::tool
