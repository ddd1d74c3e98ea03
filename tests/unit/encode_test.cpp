// Pictures of the processor as numbers of a file, against the formulas of render/encode.comp in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "image/encode.h"

namespace vitrail::tests {
namespace {

using namespace vitrail::tool;

double curve(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
}

std::array<std::uint8_t, 4> shallow(std::array<float, 4> pixel) {
  std::array<std::uint8_t, 4> result{};
  encodePixels(pixel.data(), 1, result.data());
  return result;
}

std::array<std::uint16_t, 4> deep(std::array<float, 4> pixel, Encoding encoding = Encoding::Srgb16) {
  std::array<std::uint16_t, 4> result{};
  encodePixels(pixel.data(), 1, encoding, result.data());
  return result;
}

TEST(Encode, EightBitsAreTheNearestCodeOfEveryFloat) {
  int wrong = 0;
  for (std::uint32_t bits = 0; bits < 0x40000000U; bits += 1009) { // up to 2
    const auto linear = std::bit_cast<float>(bits);
    wrong += shallow({linear, 0.0F, 0.0F, 1.0F})[0] != static_cast<int>(curve(linear) * 255.0 + 0.5);
  }
  EXPECT_EQ(wrong, 0);
}

// Also the floats on both sides of where a code begins.
TEST(Encode, EightBitCodesBeginWhereTheyShould) {
  for (int code = 1; code < 256; ++code) {
    const double coded = (code - 0.5) / 255.0;
    const double start = coded <= 12.92 * 0.0031308 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
    auto above = static_cast<float>(start);
    if (static_cast<double>(above) < start) above = std::nextafter(above, 2.0F);
    EXPECT_EQ(shallow({above, 0.0F, 0.0F, 1.0F})[0], code);
    EXPECT_EQ(shallow({std::nextafter(above, 0.0F), 0.0F, 0.0F, 1.0F})[0], code - 1);
  }
}

TEST(Encode, SixteenBitsAreWithinAHundredthOfAStep) {
  double worst = 0.0;
  for (std::uint32_t bits = 0x30000000U; bits < 0x3f900000U; bits += 977) {
    const auto linear = std::bit_cast<float>(bits);
    worst = std::max(worst, std::abs(deep({linear, 0.0F, 0.0F, 1.0F})[0] - curve(linear) * 65535.0));
  }
  EXPECT_LT(worst, 0.51);
}

TEST(Encode, HalvesAreTheNearest) {
  EXPECT_EQ(deep({0.0F, -0.0F, 1.0F, 65504.0F}, Encoding::Linear),
            (std::array<std::uint16_t, 4>{0x0000, 0x8000, 0x3c00, 0x7bff}));
  EXPECT_EQ(deep({0x1.002p0F, 0x1.006p0F, 0x1.0021p0F, 0x1p-25F}, Encoding::Linear), // ties go to even
            (std::array<std::uint16_t, 4>{0x3c00, 0x3c02, 0x3c01, 0x0000}));
  EXPECT_EQ(deep({0x1p-24F, 0x1.8p-24F, 0x1.ff8p-15F, 70000.0F}, Encoding::Linear),
            (std::array<std::uint16_t, 4>{0x0001, 0x0002, 0x03ff, 0x7c00}));
  EXPECT_EQ(deep({std::numeric_limits<float>::quiet_NaN(), 0.5F, 0.25F, 2.0F}, Encoding::Linear),
            (std::array<std::uint16_t, 4>{0, 0x3800, 0x3400, 0x4000}));
}

TEST(Encode, WhatIsNoColourIsBlackAndWhatIsTooBrightIsWhite) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(shallow({kNaN, -1.0F, kInfinity, 1.0F}), (std::array<std::uint8_t, 4>{0, 0, 255, 255}));
  EXPECT_EQ(shallow({7.0F, 0.5F, 0.0F, 2.0F}), (std::array<std::uint8_t, 4>{255, 188, 0, 255}));
  EXPECT_EQ(shallow({0.0F, 0.0F, 0.0F, kNaN}), (std::array<std::uint8_t, 4>{0, 0, 0, 0}));
  EXPECT_EQ(deep({kNaN, -1.0F, kInfinity, 1.0F}), (std::array<std::uint16_t, 4>{0, 0, 65535, 65535}));
}

TEST(Encode, AlphaIsStraight) {
  EXPECT_EQ(shallow({0.0F, 0.0F, 0.0F, 0.0F}), (std::array<std::uint8_t, 4>{0, 0, 0, 0}));
  EXPECT_EQ(shallow({0.25F, 0.0F, 0.5F, 0.5F}), (std::array<std::uint8_t, 4>{188, 0, 255, 128}));
  EXPECT_EQ(deep({0.25F, 0.0F, 0.5F, 0.5F})[3], 32768);
}

// Light that alpha leaves free raises it, so that over black it is as bright as it was.
TEST(Encode, LightWithoutAlphaIsSeen) {
  const std::array<std::uint8_t, 4> flame = shallow({0.5F, 0.2F, 0.0F, 0.0F});
  EXPECT_EQ(flame[3], static_cast<int>(std::ceil(curve(0.5) * 255.0)));
  EXPECT_NEAR(flame[0] * flame[3] / 255.0, curve(0.5) * 255.0, 1.0);
  EXPECT_NEAR(flame[1] * flame[3] / 255.0, curve(0.2) * 255.0, 1.0);
  EXPECT_EQ(flame[2], 0);
}

} // namespace
} // namespace vitrail::tests
