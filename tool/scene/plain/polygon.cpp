// Splits polygons into triangles.
#include "polygon.h"

#include <cmath>
#include <cstddef>

namespace vitrail::tool {
namespace {

// The corners in a plane, turned so that the polygon runs counter-clockwise.
std::vector<glm::dvec2> flatten(std::span<const std::uint32_t> corners, std::span<const glm::vec3> positions) {
  // Newell's method: the area vector of a closed line.
  glm::dvec3 area(0.0);
  const glm::dvec3 origin(positions[corners[0]]);
  for (std::size_t i = 0; i < corners.size(); ++i)
    area += glm::cross(glm::dvec3(positions[corners[i]]) - origin,
                       glm::dvec3(positions[corners[(i + 1) % corners.size()]]) - origin);
  const glm::dvec3 size = glm::abs(area);
  const int drop = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
  const int u = (drop + 1) % 3;
  const int v = (drop + 2) % 3;
  const bool turned = area[drop] < 0.0;
  std::vector<glm::dvec2> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    const glm::dvec3 p = glm::dvec3(positions[corner]) - origin;
    points.emplace_back(turned ? -p[u] : p[u], p[v]);
  }
  return points;
}

// Above zero where a, b, c turn left.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool isConvex(std::span<const glm::dvec2> points) {
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i)
    if (turn(points[i], points[(i + 1) % count], points[(i + 2) % count]) < 0.0) return false;
  return true;
}

// Whether the corner at `place` of the remaining ones can be cut off: it turns left, and no other corner lies inside.
bool isEar(std::span<const glm::dvec2> points, std::span<const std::size_t> left, std::size_t place) {
  const std::size_t before = (place + left.size() - 1) % left.size();
  const std::size_t after = (place + 1) % left.size();
  const glm::dvec2& a = points[left[before]];
  const glm::dvec2& b = points[left[place]];
  const glm::dvec2& c = points[left[after]];
  if (turn(a, b, c) <= 0.0) return false;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (i == before || i == place || i == after) continue;
    const glm::dvec2& p = points[left[i]];
    // A corner of the ear may occur twice, where a hole is cut into a polygon.
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
  }
  return true;
}

} // namespace

void addPolygon(std::span<const std::uint32_t> corners, std::span<const glm::vec3> positions,
                std::vector<std::uint32_t>& triangles) {
  if (corners.size() < 3) return;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    triangles.insert(triangles.end(), {corners[a], corners[b], corners[c]});
  };
  // Looking for ears takes time with the cube of the number of corners.
  constexpr std::size_t mostClipped = 300;
  const std::vector<glm::dvec2> points = flatten(corners, positions);
  std::vector<std::size_t> left(corners.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  if (corners.size() > 3 && corners.size() <= mostClipped && !isConvex(points)) {
    for (std::size_t place = 0; left.size() > 3 && place < left.size();) {
      if (!isEar(points, left, place)) {
        ++place;
        continue;
      }
      add(left[(place + left.size() - 1) % left.size()], left[place], left[(place + 1) % left.size()]);
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(place));
      place = 0;
    }
  }
  for (std::size_t i = 1; i + 1 < left.size(); ++i) add(left[0], left[i], left[i + 1]);
}

} // namespace vitrail::tool
