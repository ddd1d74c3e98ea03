// The facets of an STL file.
#include "stl_facets.h"

#include <cmath>
#include <limits>

namespace vitrail::tool {

void StlFacets::add(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& origin, std::uint32_t color) {
  std::array<glm::vec3, 3> places;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 moved = corners[i] - origin;
    constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());
    if (!(std::abs(moved.x) <= largest && std::abs(moved.y) <= largest && std::abs(moved.z) <= largest)) {
      ++notFinite;
      return;
    }
    places[i] = glm::vec3(moved);
  }
  for (const glm::dvec3& corner : corners) bounds.add(corner);
  const std::array<std::uint32_t, 3> numbers = vertices.add(places, color);
  indices.insert(indices.end(), numbers.begin(), numbers.end());
}

void StlFacets::append(StlFacets part) {
  const std::vector<Welder::Key> keys = part.vertices.take();
  std::vector<std::uint32_t> numbers;
  numbers.reserve(keys.size());
  for (const Welder::Key& key : keys) numbers.push_back(vertices.add(key.position, key.tag));
  indices.reserve(indices.size() + part.indices.size());
  for (const std::uint32_t index : part.indices) indices.push_back(numbers[index]);
  bounds.min = glm::min(bounds.min, part.bounds.min);
  bounds.max = glm::max(bounds.max, part.bounds.max);
  notFinite += part.notFinite;
  cutOff = cutOff || part.cutOff;
}

} // namespace vitrail::tool
