// The sRGB curve of IEC 61966-2-1, from encoded to linear.
#pragma once

#include <glm/glm.hpp>

namespace vitrail::tool {

// What lies outside [0, 1] is clamped; a NaN becomes 0.
double linearFromSrgb(double encoded);
glm::vec3 linearFromSrgb(const glm::vec3& srgb);

} // namespace vitrail::tool
