// The node formats on the CPU: their bits by hand, their rounding as vitrail.h states it at every boundary, their
// order.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "../reference/node.h"
#include "core/pool.h"

namespace vitrail::tests {
namespace {

using namespace layout;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();

std::vector<NodeCoding> everyCoding() {
  std::vector<NodeCoding> codings;
  for (const std::uint32_t format : {VITRAIL_FORMAT_STANDARD, VITRAIL_FORMAT_COMPACT, VITRAIL_FORMAT_HDR}) {
    for (const std::uint32_t samples : {1U, 2U, 4U, 8U}) {
      if (maxNodeIndexCount(format, samples) == 0) continue;
      for (const bool nearestIsOne : {false, true}) codings.push_back({format, samples, nearestIsOne});
    }
  }
  return codings;
}

std::string describe(const NodeCoding& coding) {
  return "format " + std::to_string(coding.format) + ", " + std::to_string(coding.samples) + " samples, nearest is " +
         (coding.nearestIsOne ? "one" : "zero");
}

// A fragment after storing.
Fragment stored(const NodeCoding& coding, const Fragment& fragment) {
  const std::optional<NodeWords> words = packNode(coding, fragment);
  EXPECT_TRUE(words.has_value()) << describe(coding);
  return words ? unpackNode(coding, *words) : Fragment{};
}

float storedDepth(const NodeCoding& coding, float depth) {
  return stored(coding, {{1.0, 1.0, 1.0, 1.0}, depth, VITRAIL_OVER, 1}).depth;
}

TEST(NodeFormats, StandardByHand) {
  // 188/255 on the curve is linear 0.5029; alpha 128/255; depth 0.5 = 0x3f000000; multiply = 3.
  const Fragment fragment = {{srgbToLinear(188 / 255.0), 1.0, 0.0, 0.5}, 0.5F, VITRAIL_MULTIPLY, 0x5};
  EXPECT_EQ(*packNode({VITRAIL_FORMAT_STANDARD, 4, false}, fragment),
            (NodeWords{0x8000ffbcU, 0xff000000U, 0x50000000U, 0}));
  EXPECT_EQ(*packNode({VITRAIL_FORMAT_STANDARD, 8, false}, fragment),
            (NodeWords{0x8000ffbcU, 0xff000000U, 0x05000000U, 0}));
  EXPECT_EQ(*packNode({VITRAIL_FORMAT_STANDARD, 1, false}, fragment), (NodeWords{0x8000ffbcU, 0xff000000U, 0, 0}));
}

// Anywhere in [0, 1]; whole steps of the curve come through as they are.
TEST(NodeFormats, ColoursThatComputeEncodesRoundAsStated) {
  const NodeCoding coding{VITRAIL_FORMAT_STANDARD, 1, false, true};
  constexpr int kParts = 400; // of a step
  for (int i = 0; i <= 255 * kParts; ++i) {
    const double curve = i / (255.0 * kParts);
    const double linear = srgbToLinear(curve);
    const Fragment kept = stored(coding, {{linear, linear, linear, 1.0}, 0.5F});
    for (unsigned c = 0; c < 3; ++c) {
      const double bound = i % kParts == 0 ? 1e-9 : (c == 2 ? 0.9 : 0.7) / 255;
      ASSERT_NEAR(linearToSrgb(kept.color[c]), curve, bound) << curve;
    }
  }
  const Fragment hostile = stored(coding, {{kNan, kInfinity, -kInfinity, 1.0}, 0.5F});
  EXPECT_EQ(hostile.color, (Color{0.0, 1.0, 0.0, 1.0}));
}

TEST(NodeFormats, CompactByHand) {
  // Nearness 0.5 = 2^-1: the 31st of 32 exponents, so code 30 << 11.
  const Fragment fragment = {{1.0, 0.0, srgbToLinear(16 / 31.0), 22 / 63.0}, 0.5F, VITRAIL_ADDITIVE, 0x9};
  EXPECT_EQ(*packNode({VITRAIL_FORMAT_COMPACT, 1, true}, fragment),
            (NodeWords{0xf000801fU, 0x96000000U, 0, 0})); // r 31, b 16 << 11; alpha 22 = 0x16 | additive << 30
  // Alpha 22/63 = 10.8/31 is 11 = 0b01011: 0b011 in bit 15, 0b01 in bit 28. Code 30 << 9 in bit 18.
  EXPECT_EQ(*packNode({VITRAIL_FORMAT_COMPACT, 4, true}, fragment),
            (NodeWords{30U << 27U | 3U << 15U | 16U << 10U | 31U, 0x99000000U, 0, 0}));
}

TEST(NodeFormats, HdrByHand) {
  // 3.5 = 1.75 * 2: 0x4300; 65504 = 0x7bff; 2^-24, the smallest: 0x0001. Alpha 1 = 0xffff. Depth 1.
  const Fragment fragment = {{3.5, 65504.0, 0x1p-24, 1.0}, 1.0F, VITRAIL_PREMULTIPLIED, 0x80};
  EXPECT_EQ(*packNode({VITRAIL_FORMAT_HDR, 8, false}, fragment),
            (NodeWords{0x7bff4300U, 0xffff0001U, 0x7f800000U, 0x80000000U}));
}

TEST(NodeFormats, TheCurveIsSrgbs) {
  EXPECT_NEAR(srgbToLinear(0.5), 0.21404114, 1e-8);
  EXPECT_NEAR(srgbToLinear(0.04), 0.04 / 12.92, 1e-12);
  EXPECT_NEAR(linearToSrgb(0.5), 0.73535698, 1e-8);
}

TEST(NodeFormats, EveryHalfSurvivesAndValuesBetweenGoToTheNearest) {
  for (std::uint32_t bits = 0; bits < 0x7bffU; ++bits) {
    const double low = fromHalf(bits);
    const double high = fromHalf(bits + 1);
    ASSERT_LT(low, high);
    ASSERT_EQ(toHalf(low), bits);
    const double middle = 0.5 * (low + high);
    ASSERT_EQ(toHalf(std::nextafter(middle, 0.0)), bits);
    ASSERT_EQ(toHalf(std::nextafter(middle, 1e9)), bits + 1);
    ASSERT_EQ(toHalf(middle) % 2, 0U);                            // ties to even
    ASSERT_LE(middle - low, std::max(middle * 0x1p-10, 0x1p-24)); // the stated error, with room for truncation
  }
  EXPECT_EQ(fromHalf(0x7bff), 65504.0);
  EXPECT_EQ(fromHalf(0x3c00), 1.0);
}

// The steps of a format's colour channels on the curve and of its alpha.
struct Steps {
  std::array<std::uint32_t, 4> largest;
};

Steps stepsOf(const NodeCoding& coding) {
  if (coding.format == VITRAIL_FORMAT_COMPACT) {
    return coding.samples == 1 ? Steps{{31, 63, 31, 63}} : Steps{{31, 31, 31, 31}};
  }
  return coding.format == VITRAIL_FORMAT_STANDARD ? Steps{{255, 255, 255, 255}} : Steps{{0, 0, 0, 65535}};
}

// Every step survives, and on both sides of the middle between two the nearer one is stored: half a step is the largest
// error there is.
TEST(NodeFormats, ColourAndAlphaAreStoredAsTheNearestStep) {
  for (const NodeCoding& coding : everyCoding()) {
    const Steps steps = stepsOf(coding);
    for (unsigned channel = 0; channel < 4; ++channel) {
      const std::uint32_t largest = steps.largest[channel];
      const bool root = coding.format == VITRAIL_FORMAT_HDR; // of alpha
      const auto decode = [&](double s) { return channel < 3 ? srgbToLinear(s) : root ? s * s : s; };
      const auto expectStored = [&](double position, std::uint32_t step) {
        Fragment fragment = {{1.0, 1.0, 1.0, 1.0}, 0.5F, VITRAIL_PREMULTIPLIED, 1};
        fragment.color[channel] = decode(position);
        const double got = stored(coding, fragment).color[channel];
        ASSERT_NEAR(got, decode(static_cast<double>(step) / largest), 1e-12) << describe(coding) << ", " << channel;
      };
      for (std::uint32_t step = 0; step < largest; ++step) {
        expectStored(static_cast<double>(step) / largest, step);
        expectStored((step + 0.5 - 1e-9) / largest, step);
        expectStored((step + 0.5 + 1e-9) / largest, step + 1);
      }
      if (largest != 0) expectStored(1.0, largest);
    }
  }
}

TEST(NodeFormats, FullDepthIsKeptToTheBit) {
  for (const NodeCoding& coding : everyCoding()) {
    if (coding.format == VITRAIL_FORMAT_COMPACT) continue;
    for (const float depth : {0.0F, 1e-44F, 1e-30F, 0.1F, 0.5F, std::nextafter(0.5F, 1.0F), 0.99999994F, 1.0F}) {
      EXPECT_EQ(storedDepth(coding, depth), depth) << describe(coding);
    }
  }
}

// Around every code's own value and both ends of its range, for both depth orders.
TEST(NodeFormats, CompactDepthKeepsItsStatedRounding) {
  for (const NodeCoding& coding : everyCoding()) {
    if (coding.format != VITRAIL_FORMAT_COMPACT) continue;
    const unsigned dropped = coding.samples == 1 ? 12 : 14;
    const double bound = coding.samples == 1 ? 0x1p-12 : 0x1p-10;
    const auto base = std::bit_cast<std::uint32_t>(0x1p-31F);
    const std::uint32_t last = 31U << (23U - dropped); // the code of 1
    double previous = -1.0;
    for (std::uint32_t code = 0; code <= last; ++code) {
      for (const int offset : {-(1 << (dropped - 1)), -1, 0, 1, (1 << (dropped - 1)) - 1}) {
        const auto n = std::bit_cast<float>(base + (code << dropped) + static_cast<std::uint32_t>(offset));
        if (n > 1.0F) continue;
        const float z = coding.nearestIsOne ? n : 1.0F - n;
        const float nearness = coding.nearestIsOne ? z : 1.0F - z; // what the shader can know of n
        const float depth = storedDepth(coding, z);
        const float got = coding.nearestIsOne ? depth : 1.0F - depth;
        if (nearness < 0x1p-31F) {
          ASSERT_EQ(got, 0.0F);
        } else if (coding.nearestIsOne && code > 0) { // 1 - z cannot be compared so closely
          ASSERT_NEAR(got, nearness, bound * double{nearness}) << describe(coding) << ", code " << code;
        }
        ASSERT_GE(double{got}, previous) << describe(coding) << ", code " << code; // monotonic
        previous = got;
      }
    }
    EXPECT_EQ(storedDepth(coding, 0.0F), 0.0F);
    EXPECT_EQ(storedDepth(coding, 1.0F), 1.0F);
  }
}

// With nearest at zero the code is that of 1 - z: the same keys as for the opposite order at 1 - z.
TEST(NodeFormats, CompactDepthOfBothOrdersMirrors) {
  for (const std::uint32_t samples : {1U, 2U, 4U}) {
    const NodeCoding zero = {VITRAIL_FORMAT_COMPACT, samples, false};
    const NodeCoding one = {VITRAIL_FORMAT_COMPACT, samples, true};
    for (int i = 0; i <= 4096; ++i) {
      const float z = static_cast<float>(i) / 4096.0F;
      ASSERT_EQ(depthKey(zero, z), depthKey(one, 1.0F - z));
    }
  }
}

TEST(NodeFormats, BlendAndCoverageSurvive) {
  for (const NodeCoding& coding : everyCoding()) {
    for (std::uint32_t coverage = 1; coverage < 1U << coding.samples; ++coverage) {
      for (std::uint32_t blend = 0; blend < 4; ++blend) {
        const Fragment got = stored(coding, {{1.0, 0.0, 1.0, 1.0}, 0.3F, blend, coverage});
        EXPECT_EQ(got.coverage, coverage) << describe(coding);
        EXPECT_EQ(got.blend, blend) << describe(coding);
      }
    }
    // Bits of samples that do not exist are no coverage.
    EXPECT_FALSE(packNode(coding, {{1.0, 1.0, 1.0, 1.0}, 0.5F, VITRAIL_OVER, 1U << coding.samples}).has_value());
    EXPECT_FALSE(packNode(coding, {{1.0, 1.0, 1.0, 1.0}, 0.5F, VITRAIL_OVER, 0}).has_value());
  }
}

TEST(NodeFormats, FragmentsThatChangeNothingAreDropped) {
  for (const NodeCoding& coding : everyCoding()) {
    const auto alphaAt = [&](double steps) {
      const double position = steps / stepsOf(coding).largest[3];
      return coding.format == VITRAIL_FORMAT_HDR ? position * position : position;
    };
    for (const double alpha : {0.0, alphaAt(0.49), -1.0, kNan, -kInfinity}) {
      for (const std::uint32_t blend : {VITRAIL_OVER, VITRAIL_ADDITIVE, VITRAIL_MULTIPLY}) {
        EXPECT_FALSE(packNode(coding, {{1.0, 1.0, 1.0, alpha}, 0.5F, blend, 1})) << describe(coding) << alpha;
      }
      EXPECT_TRUE(packNode(coding, {{0.0, 0.0, 1.0, alpha}, 0.5F, VITRAIL_PREMULTIPLIED, 1})) << describe(coding);
      EXPECT_FALSE(packNode(coding, {{0.0, -1.0, kNan, alpha}, 0.5F, VITRAIL_PREMULTIPLIED, 1})) << describe(coding);
    }
    for (std::uint32_t blend = 0; blend < 4; ++blend) {
      EXPECT_TRUE(packNode(coding, {{0.0, 0.0, 0.0, alphaAt(0.51)}, 0.5F, blend, 1})) << describe(coding);
    }
  }
}

TEST(NodeFormats, HostileValuesAreContained) {
  for (const NodeCoding& coding : everyCoding()) {
    const double brightest = coding.format == VITRAIL_FORMAT_HDR ? 65504.0 : 1.0;
    const Fragment high = stored(coding, {{kInfinity, 1e300, brightest, kInfinity}, 0.5F, VITRAIL_OVER, 1});
    EXPECT_EQ(high.color, (Color{brightest, brightest, brightest, 1.0})) << describe(coding);
    const Fragment low = stored(coding, {{-kInfinity, -1.0, kNan, 1.0}, 0.5F, VITRAIL_OVER, 1});
    EXPECT_EQ(low.color, (Color{0.0, 0.0, 0.0, 1.0})) << describe(coding);
    const float farthest = coding.nearestIsOne ? 0.0F : 1.0F;
    EXPECT_EQ(storedDepth(coding, kNanF), farthest) << describe(coding);
    EXPECT_EQ(storedDepth(coding, 5.0F), 1.0F) << describe(coding);
    EXPECT_EQ(storedDepth(coding, -std::numeric_limits<float>::infinity()), 0.0F) << describe(coding);
    EXPECT_EQ(std::signbit(storedDepth(coding, -0.0F)), false) << describe(coding);
  }
}

// Nearer depths come first whatever else differs; equal keys mean equal nodes.
TEST(NodeFormats, KeysOrderByDepthAndTellAllNodesApart) {
  for (const NodeCoding& coding : everyCoding()) {
    std::mt19937 random(7);
    const auto below = [&](std::uint32_t bound) { return static_cast<std::uint32_t>(random() % bound); };
    const auto unit = [&] { return below(9) / 8.0; };
    std::vector<NodeWords> nodes;
    for (int i = 0; i < 400; ++i) {
      const Fragment fragment = {{unit(), unit(), unit(), unit()},
                                 static_cast<float>(unit()),
                                 below(4),
                                 1 + below((1U << coding.samples) - 1)};
      if (const auto words = packNode(coding, fragment)) nodes.push_back(*words);
    }
    for (const NodeWords& a : nodes) {
      for (const NodeWords& b : nodes) {
        const SortKey keyA = sortKey(coding, a);
        const SortKey keyB = sortKey(coding, b);
        ASSERT_EQ(keyA == keyB, a == b) << describe(coding);
        const float depthA = unpackNode(coding, a).depth;
        const float depthB = unpackNode(coding, b).depth;
        if (depthA != depthB) {
          ASSERT_EQ(keyA < keyB, (depthA < depthB) != coding.nearestIsOne) << describe(coding);
        }
      }
    }
  }
}

TEST(NodeFormats, TiesAreOrderedByTheStatedWords) {
  const auto key = [](const NodeCoding& coding, const Fragment& fragment) {
    return sortKey(coding, *packNode(coding, fragment));
  };
  const Fragment over = {{1.0, 1.0, 1.0, 1.0}, 0.5F, VITRAIL_OVER, 1};
  for (const NodeCoding& coding : everyCoding()) {
    Fragment multiply = over; // the blend mode counts before everything else
    multiply.blend = VITRAIL_MULTIPLY;
    multiply.color = {0.0, 0.0, 0.0, 0.5};
    EXPECT_LT(key(coding, over), key(coding, multiply)) << describe(coding);
  }
  // Compact: alpha before coverage before blue before red.
  const NodeCoding compact = {VITRAIL_FORMAT_COMPACT, 4, false};
  const Fragment faint = {{1.0, 1.0, 1.0, 0.5}, 0.5F, VITRAIL_OVER, 15};
  const Fragment dark = {{1.0, 1.0, 0.0, 1.0}, 0.5F, VITRAIL_OVER, 2};
  const Fragment blue = {{0.0, 0.0, 1.0, 1.0}, 0.5F, VITRAIL_OVER, 1};
  const Fragment red = {{1.0, 0.0, 0.0, 1.0}, 0.5F, VITRAIL_OVER, 1};
  EXPECT_LT(key(compact, faint), key(compact, red));
  EXPECT_LT(key(compact, red), key(compact, blue));
  EXPECT_LT(key(compact, blue), key(compact, dark));
  EXPECT_EQ(key({VITRAIL_FORMAT_COMPACT, 1, true}, over)[1], 63U << 16U | 0xffffU);
  EXPECT_EQ(key(compact, faint)[1], 16U << 19U | 15U << 15U | 0x7fffU); // 0.5 * 31 = 15.5 is 16
}

} // namespace
} // namespace vitrail::tests
