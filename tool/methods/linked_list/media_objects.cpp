#include "media_objects.h"

#include <array>
#include <limits>

namespace vitrail::tool {

namespace {

// The corners of the near plane's part that the picture shows, in the GPU's space.
std::array<glm::dvec3, 4> nearCorners(const shaders::FrameData& view) {
  const glm::dmat4 fromClip = glm::inverse(glm::dmat4(view.viewProjection));
  std::array<glm::dvec3, 4> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec4 corner = fromClip * glm::dvec4(i % 2 == 0 ? -1.0 : 1.0, i < 2 ? -1.0 : 1.0, 1.0, 1.0);
    corners[i] = glm::dvec3(corner) / corner.w;
  }
  return corners;
}

// Whether the box around some points of another space meets a box. A little larger: vertices are rounded.
bool meets(const Bounds& box, const glm::dmat4& toBox, const std::array<glm::dvec3, 4>& points) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high(-std::numeric_limits<double>::infinity());
  for (const glm::dvec3& point : points) {
    const glm::dvec3 inBox(toBox * glm::dvec4(point, 1.0));
    low = glm::min(low, inBox);
    high = glm::max(high, inBox);
  }
  const glm::dvec3 margin = 1e-3 * (glm::dvec3(box.max) - glm::dvec3(box.min));
  for (int i = 0; i < 3; ++i) {
    if (low[i] > box.max[i] + margin[i] || high[i] < box.min[i] - margin[i]) return false;
  }
  return true;
}

} // namespace

MediaObjects::MediaObjects(const SceneDraws& draws, const Scene& scene)
    : table_(draws.instanceCount()), near_(draws.instanceCount()) {
  for (const GpuDraw& draw : draws.transparentDraws()) {
    const std::uint32_t material = scene.draws[draws.sourceOf(draw.firstInstance)].material;
    const Facing facing = draws.solids().of(draw.mesh, material);
    if (facing == Facing::Open) continue;
    const Bounds& box = draws.solids().boxOf(draw.mesh);
    const glm::vec4 object(draws.opacity() * absorption(scene.materials[material]),
                           static_cast<float>(facing == Facing::Inward ? shaders::MEDIA_INWARD : 0U));
    for (std::uint32_t i = draw.firstInstance; i < draw.firstInstance + draw.instanceCount; ++i) {
      table_[i].absorption = object;
      const glm::dmat4 place(draws.placeOf(scene, i));
      const bool flat = glm::determinant(place) == 0.0;
      placed_.push_back({i, flat ? glm::dmat4(1.0) : glm::inverse(place), flat, box});
    }
  }
}

void MediaObjects::setView(const shaders::FrameData& view) {
  const std::array<glm::dvec3, 4> corners = nearCorners(view);
  anyNear_ = false;
  for (const Placed& placed : placed_) {
    const bool isNear = placed.flat || meets(placed.box, placed.toBox, corners);
    anyNear_ = anyNear_ || isNear;
    near_[placed.object] = isNear;
    float& flags = table_[placed.object].absorption.w;
    const std::uint32_t inward = static_cast<std::uint32_t>(flags) & shaders::MEDIA_INWARD;
    flags = static_cast<float>(inward | (isNear ? shaders::MEDIA_NEAR : 0U));
  }
  view_.ray = view.ray;
  view_.depth = glm::vec4(view.depth.x, view.depth.y, view.eye.w, 0.0F);
}

std::vector<SurfaceRun> MediaObjects::part(std::span<const SurfaceRun> runs, bool near) const {
  std::vector<SurfaceRun> result;
  for (const SurfaceRun& run : runs) {
    const std::uint32_t end = run.firstInstance + run.instanceCount;
    for (std::uint32_t first = run.firstInstance; first < end;) {
      std::uint32_t next = first + 1;
      while (next < end && near_[next] == near_[first]) ++next;
      if (near_[first] == near) {
        result.push_back(run);
        result.back().firstInstance = first;
        result.back().instanceCount = next - first;
      }
      first = next;
    }
  }
  return result;
}

} // namespace vitrail::tool
