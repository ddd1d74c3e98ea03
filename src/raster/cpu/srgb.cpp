#include "raster/cpu/srgb.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace vitrail::raster {

namespace {

double linearOf(double code) {
  const double v = code / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

} // namespace

SrgbTables::SrgbTables() {
  for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = static_cast<float>(linearOf(static_cast<double>(i)));
  least[0] = -std::numeric_limits<float>::infinity();
  for (std::size_t i = 1; i < 256; ++i) least[i] = static_cast<float>(linearOf(static_cast<double>(i) - 0.5));
  least[256] = std::numeric_limits<float>::infinity();
  std::size_t code = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const std::uint32_t bits = kFirstBits + (static_cast<std::uint32_t>(i) << kShift);
    float v = 0.0F;
    std::memcpy(&v, &bits, sizeof(v));
    while (least[code + 1] <= v) ++code;
    codes[i] = static_cast<std::uint8_t>(code);
  }
}

std::uint8_t SrgbTables::encode(float v) const {
  if (!(v > 0.0F)) return 0;
  if (v >= 1.0F) return 255;
  std::uint32_t bits = 0;
  std::memcpy(&bits, &v, sizeof(bits));
  if (bits < kFirstBits) return 0;
  const std::uint8_t code = codes[(bits - kFirstBits) >> kShift];
  return static_cast<std::uint8_t>(code + static_cast<std::uint8_t>(v >= least[code + 1U]));
}

const SrgbTables& srgbTables() {
  static const SrgbTables tables; // constant once made
  return tables;
}

} // namespace vitrail::raster
