#include "placement.h"

namespace vitrail::tool {

glm::dvec3 drawnOrigin(const Scene& scene) {
  if (scene.draws.empty()) return glm::dvec3(0.0);
  const Bounds bounds = worldBounds(scene);
  const glm::dvec3 low(bounds.min);
  const glm::dvec3 high(bounds.max);
  const glm::dvec3 middle = 0.5 * (low + high);
  return glm::length(middle) > 8.0 * glm::length(high - low) ? middle : glm::dvec3(0.0);
}

glm::mat4 placed(const glm::mat4& transform, const glm::dvec3& origin) {
  glm::mat4 place = transform;
  place[3] = glm::vec4(glm::dvec3(transform[3]) - origin, 1.0);
  return place;
}

glm::vec4 placedClipPlane(const glm::dvec4& plane, const glm::dvec3& origin) {
  return {glm::dvec3(plane), glm::dot(glm::dvec3(plane), origin) - plane.w};
}

} // namespace vitrail::tool
