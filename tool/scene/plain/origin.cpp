#include "origin.h"

#include <algorithm>
#include <cmath>

namespace vitrail::tool {

glm::dvec3 originOf(const glm::dvec3& min, const glm::dvec3& max) {
  // At 16 times a model's size floats are 2^-20 of the size apart, which is well below a pixel.
  constexpr double far = 16.0;
  const glm::dvec3 middle = 0.5 * (min + max);
  const glm::dvec3 extents = max - min;
  const double size = std::max({extents.x, extents.y, extents.z});
  const double distance = std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)});
  if (!(distance > far * size)) return glm::dvec3(0.0);
  // Whole units keep what is left of short decimals short.
  return size > 2.0 ? glm::round(middle) : middle;
}

} // namespace vitrail::tool
