#include "turntable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include <glm/gtc/matrix_transform.hpp>

namespace vitrail::tool {

namespace {

constexpr std::size_t kSlices = 256;
constexpr int kSides = 64;

// One height of what a scene sweeps.
struct Slice {
  double radius = -1.0; // none there
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
};

// Points around all that a scene sweeps when it is turned about the vertical axis through `middle`.
std::vector<glm::dvec3> sweptPoints(const Scene& scene, const glm::dvec3& middle) {
  const Bounds bounds = worldBounds(scene);
  const double bottom = bounds.min.y;
  const double height = std::max(static_cast<double>(bounds.max.y) - bottom, 1e-30);
  std::array<Slice, kSlices> slices;
  visitPositions(scene, [&](std::span<const glm::vec3> positions) {
    for (const glm::dvec3 position : positions) {
      const double share = (position.y - bottom) / height;
      Slice& slice = slices[static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * (kSlices - 1))];
      slice.radius = std::max(slice.radius, std::hypot(position.x - middle.x, position.z - middle.z));
      slice.low = std::min(slice.low, position.y);
      slice.high = std::max(slice.high, position.y);
    }
  });
  std::vector<glm::dvec3> points;
  for (const Slice& slice : slices) {
    if (slice.radius < 0.0) continue;
    const double radius = slice.radius / std::cos(std::numbers::pi / kSides); // the polygon is around the circle
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2.0 * std::numbers::pi * side / kSides;
      const glm::dvec3 place(middle.x + radius * std::cos(angle), slice.low, middle.z + radius * std::sin(angle));
      points.push_back(place);
      points.emplace_back(place.x, slice.high, place.z);
    }
  }
  return points;
}

std::vector<View> around(const View& first, const glm::dvec3& middle, std::uint32_t count) {
  std::vector<View> views(count, first);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    glm::dmat4 turn = glm::translate(glm::dmat4(1.0), middle);
    turn = glm::rotate(turn, angle, glm::dvec3(0.0, 1.0, 0.0));
    turn = glm::translate(turn, -middle);
    views[i].cameraToWorld = glm::mat4(turn * glm::dmat4(first.cameraToWorld));
  }
  return views;
}

} // namespace

std::vector<View> turntable(const Scene& scene, const Orbit& orbit, float aspect, std::uint32_t count) {
  const Bounds bounds = worldBounds(scene);
  const glm::dvec3 middle = 0.5 * (glm::dvec3(bounds.min) + glm::dvec3(bounds.max));
  return around(frameScene(sweptPoints(scene, middle), orbit, aspect), middle, count);
}

std::vector<View> turntable(const Scene& scene, const LookAt& look, std::uint32_t count) {
  return around(lookFrom(sweptPoints(scene, look.target), look), look.target, count);
}

} // namespace vitrail::tool
