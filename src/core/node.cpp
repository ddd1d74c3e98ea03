#include "node.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vitrail {

namespace {

constexpr std::uint32_t kOneBits = std::bit_cast<std::uint32_t>(1.0F);

std::uint32_t toUnorm8(double v) { return static_cast<std::uint32_t>(std::lround(v * 255.0)); }

double saturate(double v) { return std::isnan(v) ? 0.0 : std::clamp(v, 0.0, 1.0); }

} // namespace

double linearToSrgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double srgbToLinear(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

std::uint32_t packColor(const Color& color) {
  std::uint32_t bits = toUnorm8(saturate(color[3])) << 24U;
  for (unsigned i = 0; i < 3; ++i) bits |= toUnorm8(linearToSrgb(saturate(color[i]))) << (8U * i);
  return bits;
}

Color unpackColor(std::uint32_t bits) {
  Color color{};
  for (unsigned i = 0; i < 3; ++i) color[i] = srgbToLinear(((bits >> (8U * i)) & 0xffU) / 255.0);
  color[3] = (bits >> 24U) / 255.0;
  return color;
}

std::uint32_t packDepth(float depth, bool nearestIsOne) {
  if (std::isnan(depth)) return nearestIsOne ? 0U : kOneBits;
  return std::bit_cast<std::uint32_t>(std::clamp(depth, 0.0F, 1.0F)) & 0x7fffffffU; // -0.0 is 0.0
}

std::uint32_t depthKey(std::uint32_t depthBits, bool nearestIsOne) {
  return nearestIsOne ? kOneBits - std::min(depthBits, kOneBits) : depthBits;
}

} // namespace vitrail
