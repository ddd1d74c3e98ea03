// The core: node packing, pool sizes, the reference resolve, each against values worked out by hand.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "core/node.h"
#include "core/pool.h"
#include "core/reference_resolve.h"

namespace vitrail::tests {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Node, EightBitColoursSurviveExactly) {
  for (std::uint32_t v = 0; v < 256; ++v) {
    const std::uint32_t bits = v | (v << 8U) | (v << 16U) | (v << 24U);
    EXPECT_EQ(packColor(unpackColor(bits)), bits);
  }
}

TEST(Node, TheCurveIsSrgbs) {
  EXPECT_NEAR(srgbToLinear(0.5), 0.21404114, 1e-8);
  EXPECT_NEAR(srgbToLinear(0.04), 0.04 / 12.92, 1e-12);
  EXPECT_NEAR(linearToSrgb(0.5), 0.73535698, 1e-8);
}

TEST(Node, ColoursOutsideTheRangeAreClamped) {
  EXPECT_EQ(packColor({2.0, -1.0, 0.0, 7.0}), 0xff0000ffU);
  EXPECT_EQ(packColor({kInfinity, -kInfinity, kNan, 1.0}), 0xff0000ffU);
  EXPECT_EQ(packColor({1.0, 1.0, 1.0, kNan}), 0x00ffffffU);
}

TEST(Node, DepthKeysGrowAwayFromTheViewer) {
  const auto key = [](float depth, bool nearestIsOne) {
    return depthKey(packDepth(depth, nearestIsOne), nearestIsOne);
  };
  const float depths[] = {0.0F, 1e-30F, 0.1F, 0.5F, std::nextafter(0.5F, 1.0F), 1.0F};
  for (std::size_t i = 1; i < std::size(depths); ++i) {
    EXPECT_LT(key(depths[i - 1], false), key(depths[i], false));
    EXPECT_GT(key(depths[i - 1], true), key(depths[i], true));
  }
  EXPECT_EQ(key(-0.0F, false), key(0.0F, false));
  EXPECT_EQ(key(-5.0F, false), key(0.0F, false));
  EXPECT_EQ(key(5.0F, false), key(1.0F, false));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(key(nan, false), key(1.0F, false));
  EXPECT_EQ(key(nan, true), key(0.0F, true));
}

TEST(Pool, SizesDoNotOverflow) {
  EXPECT_EQ(nodePoolBytes(0), 12U);
  EXPECT_EQ(nodePoolBytes(1), 12U);
  EXPECT_EQ(nodePoolBytes(0xfffffffeU), 0xfffffffeULL * 12U);
  EXPECT_EQ(headBytes(65536, 65536), 4ULL * 65536U * 65536U);
  EXPECT_EQ(nodesThatFit(11), 0U);
  EXPECT_EQ(nodesThatFit(std::uint64_t{1} << 27U), 11184810U);
  EXPECT_EQ(nodesThatFit(~std::uint64_t{0}), 0xfffffffeU);
}

TEST(ReferenceResolve, TwoLayersByHand) {
  // Half red at 0.25 in front of half green at 0.75 over blue: 128/255 is the stored half.
  const double a = 128.0 / 255.0;
  const StoredFragment red = {packColor({1.0, 0.0, 0.0, 0.5}), packDepth(0.25F, false)};
  const StoredFragment green = {packColor({0.0, 1.0, 0.0, 0.5}), packDepth(0.75F, false)};
  const Color blue = {0.0, 0.0, 1.0, 1.0};
  for (const auto& list : {std::array{red, green}, std::array{green, red}}) {
    const Color near = resolveReference(list, blue, false);
    EXPECT_NEAR(near[0], a, 1e-12);
    EXPECT_NEAR(near[1], (1 - a) * a, 1e-12);
    EXPECT_NEAR(near[2], (1 - a) * (1 - a), 1e-12);
    EXPECT_NEAR(near[3], 1.0, 1e-12);
    const Color reversed = resolveReference(list, blue, true); // now 0.75 is nearer
    EXPECT_NEAR(reversed[0], (1 - a) * a, 1e-12);
    EXPECT_NEAR(reversed[1], a, 1e-12);
  }
}

TEST(ReferenceResolve, NothingChangesNothing) {
  const Color behind = {0.1, 0.2, 0.3, 0.4};
  const Color result = resolveReference({}, behind, false);
  for (unsigned i = 0; i < 4; ++i) EXPECT_NEAR(result[i], behind[i], 1e-15);
}

} // namespace
} // namespace vitrail::tests
