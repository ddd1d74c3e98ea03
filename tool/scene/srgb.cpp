#include "srgb.h"

#include <cmath>

namespace vitrail::tool {

namespace {

// In double, so that an 8-bit value survives the way to linear light and back.
float linear(float encoded) {
  if (!(encoded > 0.0F)) return 0.0F;
  if (encoded >= 1.0F) return 1.0F;
  const double value = encoded;
  return static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
}

} // namespace

glm::vec3 linearFromSrgb(const glm::vec3& srgb) { return {linear(srgb.r), linear(srgb.g), linear(srgb.b)}; }

} // namespace vitrail::tool
