#include "tile_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vitrail::tool {

namespace {

constexpr double kRounding = 1e-6; // what a device's sums may be off, as a share of their largest term
constexpr double kMargin = 2.0;    // pixels: snapping, and lines, which are a pixel wide

bool follows(const SurfaceRun& before, const SurfaceRun& run) {
  return before.draw == run.draw && before.firstInstance + before.instanceCount == run.firstInstance;
}

} // namespace

TileRuns::TileRuns(const Surfaces& surfaces, VkExtent2D extent) : picture_(extent) {
  const std::vector<PlacedBox>& boxes = surfaces.scene().transparentBoxes();
  const std::vector<SurfaceRun>& draws = surfaces.transparentRuns();
  const bool oneEach = boxes.size() == draws.size(); // else one for every instance
  for (const SurfaceRun& draw : draws) {
    for (std::uint32_t i = 0; i < (oneEach ? 1 : draw.instanceCount); ++i) {
      runs_.push_back(draw);
      if (oneEach) continue;
      runs_.back().firstInstance = draw.firstInstance + i;
      runs_.back().instanceCount = 1;
    }
  }
  const glm::dmat4 clipFromWorld(surfaces.view().viewProjection);
  const double margin = kMargin + 0.5 * static_cast<double>(surfaces.pointSize());
  extents_.reserve(runs_.size());
  for (std::size_t i = 0; i < runs_.size(); ++i) extents_.push_back(project(boxes.at(i), clipFromWorld, margin));
}

// Everything, where the box reaches the eye's plane or is nowhere.
TileRuns::Extent TileRuns::project(const PlacedBox& box, const glm::dmat4& clipFromWorld, double margin) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Extent everything{-kInfinity, kInfinity, -kInfinity, kInfinity};
  const glm::dmat4 clipFromBox = clipFromWorld * glm::dmat4(box.model);
  Extent extent{kInfinity, -kInfinity, kInfinity, -kInfinity};
  for (const glm::vec3& corner : cornersOf(box.box)) {
    const glm::dvec4 at(glm::dvec3(corner), 1.0);
    const glm::dvec4 clip = clipFromBox * at;
    double magnitude = 0.0; // of the largest term
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 4; ++row)
        magnitude = std::max(magnitude, std::abs(clipFromBox[column][row] * at[column]));
    }
    const double slack = kRounding * magnitude;
    if (!std::isfinite(clip.x + clip.y + clip.w) || !(clip.w > slack)) return everything;
    const double pixels = margin + slack / clip.w * std::max(picture_.width, picture_.height);
    const double x = (clip.x / clip.w + 1.0) * 0.5 * picture_.width;
    const double y = (clip.y / clip.w + 1.0) * 0.5 * picture_.height;
    extent.left = std::min(extent.left, x - pixels);
    extent.right = std::max(extent.right, x + pixels);
    extent.top = std::min(extent.top, y - pixels);
    extent.bottom = std::max(extent.bottom, y + pixels);
  }
  return extent;
}

std::vector<SurfaceRun> TileRuns::touching(const VkRect2D& area) const {
  const double left = area.offset.x;
  const double top = area.offset.y;
  const double right = left + area.extent.width;
  const double bottom = top + area.extent.height;
  std::vector<SurfaceRun> result;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const Extent& extent = extents_[i];
    if (extent.right < left || extent.left > right || extent.bottom < top || extent.top > bottom) continue;
    if (!result.empty() && follows(result.back(), runs_[i])) {
      result.back().instanceCount += runs_[i].instanceCount;
    } else {
      result.push_back(runs_[i]);
    }
  }
  return result;
}

} // namespace vitrail::tool
