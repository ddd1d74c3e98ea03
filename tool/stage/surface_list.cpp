#include "surface_list.h"

#include <algorithm>

#include "placement.h"

namespace vitrail::tool {

namespace {

// The scene's clip planes in the GPU's space, filled up with planes that keep everything.
void putClipPlanes(const Scene& scene, const glm::dvec3& origin, shaders::FrameData& view) {
  static_assert(kMostClipPlanes == shaders::CLIP_PLANE_COUNT);
  for (std::size_t i = 0; i < shaders::CLIP_PLANE_COUNT; ++i) {
    view.clipPlanes[i] = glm::vec4(0.0F, 0.0F, 0.0F, 1.0F);
    if (i >= scene.clipPlanes.size()) continue;
    view.clipPlanes[i] = placedClipPlane(scene.clipPlanes[i], origin);
  }
}

} // namespace

std::vector<SurfaceRun> runsOf(std::span<const GpuDraw> draws) {
  std::vector<SurfaceRun> runs;
  runs.reserve(draws.size());
  for (std::uint32_t i = 0; i < draws.size(); ++i) {
    const GpuDraw& draw = draws[i];
    runs.push_back({i, draw.firstIndex, draw.indexCount, draw.firstInstance, draw.instanceCount});
  }
  return runs;
}

SurfaceList::SurfaceList(const SceneDraws& draws, const Scene& scene, std::size_t lights)
    : draws_(draws), transparentRuns_(runsOf(draws.transparentDraws())), isClipped_(!scene.clipPlanes.empty()) {
  view_.toLight.w = static_cast<float>(lights);
  putClipPlanes(scene, draws.origin(), view_);
}

void SurfaceList::setClipPlanes(const Scene& scene) { putClipPlanes(scene, draws_.origin(), view_); }

void SurfaceList::setView(const shaders::FrameData& view) {
  const shaders::FrameData last = view_;
  view_ = view;
  view_.toLight.w = last.toLight.w;
  std::ranges::copy(last.clipPlanes, view_.clipPlanes);
}

} // namespace vitrail::tool
