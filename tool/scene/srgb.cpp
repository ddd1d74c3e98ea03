#include "srgb.h"

#include <cmath>

namespace vitrail::tool {

double linearFromSrgb(double encoded) {
  if (!(encoded > 0.0)) return 0.0;
  if (encoded >= 1.0) return 1.0;
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// In double, so that an 8-bit value survives the way to linear light and back.
glm::vec3 linearFromSrgb(const glm::vec3& srgb) {
  const auto linear = [](float encoded) { return static_cast<float>(linearFromSrgb(double{encoded})); };
  return {linear(srgb.r), linear(srgb.g), linear(srgb.b)};
}

} // namespace vitrail::tool
