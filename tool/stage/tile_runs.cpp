#include "tile_runs.h"

#include <cstdint>
#include <cstring>

namespace vitrail::tool {

namespace {

bool follows(const SurfaceRun& before, const SurfaceRun& run) {
  return before.draw == run.draw && before.firstInstance + before.instanceCount == run.firstInstance;
}

bool meet(std::int64_t a, std::int64_t aSize, std::int64_t b, std::int64_t bSize) {
  return a < b + bSize && b < a + aSize;
}

} // namespace

std::vector<VitrailBounds> clipBoxesOf(const SurfaceList& surfaces) {
  std::vector<VitrailBounds> result;
  result.reserve(surfaces.scene().transparentBoxes().size());
  for (const PlacedBox& placed : surfaces.scene().transparentBoxes()) {
    const glm::mat4 clip(glm::dmat4(surfaces.view().viewProjection) * glm::dmat4(placed.model));
    VitrailBounds bounds{};
    std::memcpy(bounds.min, &placed.box.min, sizeof(bounds.min));
    std::memcpy(bounds.max, &placed.box.max, sizeof(bounds.max));
    std::memcpy(bounds.clipFromBox, &clip, sizeof(bounds.clipFromBox));
    result.push_back(bounds);
  }
  return result;
}

bool drawsPoints(const GpuDraw& draw) { return (draw.features & shaders::FEATURE_SOLID) == shaders::FEATURE_POINTS; }

TileRuns::TileRuns(const SurfaceList& surfaces, std::uint32_t width, std::uint32_t height) {
  const std::vector<VitrailBounds> boxes = clipBoxesOf(surfaces);
  const std::vector<SurfaceRun>& draws = surfaces.transparentRuns();
  const bool oneEach = boxes.size() == draws.size(); // else one for every instance
  for (const SurfaceRun& draw : draws) {
    const bool points = drawsPoints(surfaces.scene().transparentDraws().at(draw.draw));
    for (std::uint32_t i = 0; i < (oneEach ? 1 : draw.instanceCount); ++i) {
      VitrailRect area{0, 0, width, height};
      if (!points) vitrailProjectBounds(1, &boxes.at(runs_.size()), width, height, &area);
      areas_.push_back(area);
      runs_.push_back(draw);
      if (oneEach) continue;
      runs_.back().firstInstance = draw.firstInstance + i;
      runs_.back().instanceCount = 1;
    }
  }
}

std::vector<SurfaceRun> TileRuns::touching(const VitrailRect& area) const {
  std::vector<SurfaceRun> result;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const VitrailRect& reached = areas_[i];
    if (!meet(reached.x, reached.width, area.x, area.width) || !meet(reached.y, reached.height, area.y, area.height)) {
      continue;
    }
    if (!result.empty() && follows(result.back(), runs_[i])) {
      result.back().instanceCount += runs_[i].instanceCount;
    } else {
      result.push_back(runs_[i]);
    }
  }
  return result;
}

} // namespace vitrail::tool
