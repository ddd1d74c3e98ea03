#include "project_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vitrail {

namespace {

struct ClipPoint {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 0.0;
};

using Corners = std::array<ClipPoint, 8>;

constexpr double kRounding = 1e-6; // what a device's sums may be off, as a share of their largest term
constexpr double kMargin = 1.0;    // pixels

// Bounds of pixels; empty as it starts.
struct PixelBounds {
  double left = std::numeric_limits<double>::infinity();
  double right = -std::numeric_limits<double>::infinity();
  double top = std::numeric_limits<double>::infinity();
  double bottom = -std::numeric_limits<double>::infinity();
};

// The box's corners in clip space, and the largest term that went into any coordinate.
Corners toClip(const ClipBox& box, double& magnitude) {
  Corners corners;
  magnitude = 0.0;
  for (unsigned i = 0; i < 8; ++i) {
    const std::array<double, 4> at = {(i & 1U) != 0 ? box.max[0] : box.min[0], (i & 2U) != 0 ? box.max[1] : box.min[1],
                                      (i & 4U) != 0 ? box.max[2] : box.min[2], 1.0};
    std::array<double, 4> clip{};
    for (unsigned column = 0; column < 4; ++column) {
      for (unsigned row = 0; row < 4; ++row) {
        const double term = double{box.clipFromBox[column * 4 + row]} * at[column];
        clip[row] += term;
        magnitude = std::max(magnitude, std::abs(term));
      }
    }
    corners[i] = {clip[0], clip[1], clip[2], clip[3]};
  }
  return corners;
}

template <typename Condition>
bool all(const Corners& corners, Condition condition) {
  return std::all_of(corners.begin(), corners.end(), condition);
}

// Whether the box is outside of one of the planes that clip, by more than rounding.
bool isOutside(const Corners& corners, double slack) {
  return all(corners, [&](const ClipPoint& p) { return p.x < -p.w - slack; }) ||
         all(corners, [&](const ClipPoint& p) { return p.x > p.w + slack; }) ||
         all(corners, [&](const ClipPoint& p) { return p.y < -p.w - slack; }) ||
         all(corners, [&](const ClipPoint& p) { return p.y > p.w + slack; }) ||
         all(corners, [&](const ClipPoint& p) { return p.z < -slack; }) ||
         all(corners, [&](const ClipPoint& p) { return p.z > p.w + slack; }) ||
         all(corners, [&](const ClipPoint& p) { return p.w < -slack; });
}

void addBox(PixelBounds& extent, const ClipBox& box, double width, double height) {
  double magnitude = 0.0;
  const Corners corners = toClip(box, magnitude);
  const double slack = kRounding * magnitude;
  const bool finite = all(corners, [](const ClipPoint& p) { return std::isfinite(p.x + p.y + p.z + p.w); });
  if (finite && isOutside(corners, slack)) return;
  if (!finite || !all(corners, [&](const ClipPoint& p) { return p.w > slack; })) {
    extent = {0.0, width, 0.0, height};
    return;
  }
  for (const ClipPoint& p : corners) {
    const double x = (p.x / p.w + 1.0) * 0.5 * width;
    const double y = (p.y / p.w + 1.0) * 0.5 * height;
    const double pixels = kMargin + slack / p.w * std::max(width, height);
    extent.left = std::min(extent.left, x - pixels);
    extent.right = std::max(extent.right, x + pixels);
    extent.top = std::min(extent.top, y - pixels);
    extent.bottom = std::max(extent.bottom, y + pixels);
  }
}

} // namespace

Rectangle projectBounds(std::span<const ClipBox> boxes, std::uint32_t width, std::uint32_t height) {
  PixelBounds extent;
  for (const ClipBox& box : boxes) {
    const bool empty = box.min[0] > box.max[0] || box.min[1] > box.max[1] || box.min[2] > box.max[2];
    if (!empty) addBox(extent, box, width, height);
  }
  const auto pixels = [](double value, std::uint32_t size) {
    return static_cast<std::uint32_t>(std::clamp<double>(value, 0.0, size));
  };
  const std::uint32_t left = pixels(std::floor(extent.left), width);
  const std::uint32_t right = pixels(std::ceil(extent.right), width);
  const std::uint32_t top = pixels(std::floor(extent.top), height);
  const std::uint32_t bottom = pixels(std::ceil(extent.bottom), height);
  if (left >= right || top >= bottom) return {};
  return {left, top, right - left, bottom - top};
}

} // namespace vitrail
