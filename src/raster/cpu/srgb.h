// Linear light to 8 bits on the sRGB curve (IEC 61966-2-1) and back, by tables.
#pragma once

#include <array>
#include <cstdint>

namespace vitrail::raster {

struct SrgbTables {
  std::array<float, 256> linear; // of each code

  // The nearest code: exactly round(255 * curve(v)). A NaN is 0.
  std::uint8_t encode(float v) const;

  // The least value of each code, and for numbers with the same exponent and first bits of the fraction the code of the
  // smallest: the codes of the others are at most one more.
  static constexpr std::uint32_t kFirstBits = 0x38800000; // 2^-14
  static constexpr std::uint32_t kShift = 15;             // leaves 8 bits of the fraction
  std::array<float, 257> least;
  std::array<std::uint8_t, ((0x3f800000 - kFirstBits) >> kShift) + 1> codes;

  SrgbTables();
};

// Made once, when first asked for.
const SrgbTables& srgbTables();

} // namespace vitrail::raster
