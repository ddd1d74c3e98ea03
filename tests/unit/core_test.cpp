// Pool sizes and the reference resolve, against values worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <span>
#include <vector>

#include "core/pool.h"
#include "core/reference_resolve.h"

namespace vitrail::tests {
namespace {

using namespace layout;

TEST(Pool, BoundsAreTheHeaders) {
  EXPECT_EQ(maxNodeIndexCount(VITRAIL_FORMAT_STANDARD, 1), 0xe0000000U);
  EXPECT_EQ(maxNodeIndexCount(VITRAIL_FORMAT_STANDARD, 2), (1U << 28U) - 2);
  EXPECT_EQ(maxNodeIndexCount(VITRAIL_FORMAT_STANDARD, 4), (1U << 28U) - 2);
  EXPECT_EQ(maxNodeIndexCount(VITRAIL_FORMAT_STANDARD, 8), (1U << 24U) - 2);
  EXPECT_EQ(maxNodeIndexCount(VITRAIL_FORMAT_HDR, 1), 0xe0000000U);
  EXPECT_EQ(maxNodeIndexCount(VITRAIL_FORMAT_HDR, 8), (1U << 24U) - 2);
  for (const std::uint32_t samples : {1U, 2U, 4U}) {
    EXPECT_EQ(maxNodeIndexCount(VITRAIL_FORMAT_COMPACT, samples), (1U << 24U) - 2);
  }
  EXPECT_EQ(maxNodeIndexCount(VITRAIL_FORMAT_COMPACT, 8), 0U);
  EXPECT_EQ(maxNodeIndexCount(VITRAIL_FORMAT_STANDARD, 3), 0U);
  EXPECT_EQ(maxNodeIndexCount(3, 1), 0U);
}

TEST(Pool, SizesDoNotOverflow) {
  EXPECT_EQ(nodePoolBytes(VITRAIL_FORMAT_STANDARD, 0), 12U);
  EXPECT_EQ(nodePoolBytes(VITRAIL_FORMAT_COMPACT, 1), 8U);
  EXPECT_EQ(nodePoolBytes(VITRAIL_FORMAT_HDR, 0xfffffffeU), 0xfffffffeULL * 16U);
  EXPECT_EQ(headBytes(0xffffffffU), 4ULL * 0xffffffffU);
  EXPECT_EQ(sumBytes(0xffffffffU), 20ULL * 0xffffffffU);
  EXPECT_EQ(listBytes(0xffffffffU, 0xffffffffU, VITRAIL_SHORT_LIST), 0xffffffffU / 17U * 4ULL);
  EXPECT_EQ(listBytes(100, 33 * 50 + 32, VITRAIL_MEDIUM_LIST), 50U * 4U);
  EXPECT_EQ(listBytes(40, 33 * 50 + 32, VITRAIL_MEDIUM_LIST), 40U * 4U);
  EXPECT_EQ(listBytes(40, 0, VITRAIL_MEDIUM_LIST), 4U);
  EXPECT_EQ(groupListBytes(0xffffffffU, 0xffffffffU), 0x1fffffffeULL / 65U * 16U);
  EXPECT_EQ(groupListBytes(1000, 33 * 10 + 65 * 50), (10U + 2U * 50U) * 16U);
  EXPECT_EQ(groupListBytes(40, 65 * 50), 80U * 16U);
  EXPECT_EQ(groupListBytes(40, 0), 16U);
  for (const std::uint32_t range : {16U, 1000U, 0x8000000U}) {
    const auto most = static_cast<std::uint32_t>(nodesForGroupLists(range));
    EXPECT_LE(groupListBytes(0xffffffffU, most), range);
    EXPECT_GT(groupListBytes(0xffffffffU, most + 65), range);
  }
}

TEST(Pool, PartsAreAlignedAndDoNotOverlap) {
  for (const std::uint64_t alignment : {256U, 4096U}) {
    for (const std::uint32_t pixels : {1U, 1000U, 1920U * 1080U, 0xffffffffU}) {
      for (const std::uint32_t capacity : {0U, 1U, 12345U, 0xfffffffeU}) {
        for (const bool keepSums : {false, true}) {
          const StorageLayout storage = layoutStorage(pixels, capacity, VITRAIL_FORMAT_HDR, keepSums, alignment);
          std::uint64_t end = 0;
          for (const StoragePart& part : {storage.parameters, storage.control, storage.heads, storage.mediumLists,
                                          storage.longLists, storage.sums, storage.nodes}) {
            EXPECT_EQ(part.offset % alignment, 0U);
            EXPECT_GE(part.offset, end);
            EXPECT_LT(part.offset, end + alignment);
            EXPECT_GE(part.size, 4U);
            end = part.offset + part.size;
          }
          EXPECT_EQ(storage.total, end);
          EXPECT_EQ(storage.parameters.size, sizeof(VitrailParameters));
          EXPECT_EQ(storage.control.size, sizeof(VitrailControl));
          EXPECT_EQ(storage.sums.size, keepSums ? std::max<std::uint64_t>(16, 20ULL * pixels) : 16U);
        }
      }
    }
  }
}

TEST(Pool, TheCapacityForABudgetIsTheLargestThatFits) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 2000; ++i) {
    const auto format = static_cast<std::uint32_t>(random() % 3);
    const std::uint32_t samples = 1U << (random() % 4);
    const auto pixels = static_cast<std::uint32_t>(random() >> (32 + random() % 32));
    const std::uint64_t bytes = random() >> (random() % 50 + 14);
    const bool keepSums = random() % 2 == 0;
    const std::uint32_t most = maxNodeIndexCount(format, samples);
    const std::uint32_t fits = nodeCapacityFor(bytes, pixels, format, samples, keepSums, 256);
    ASSERT_LE(fits, most);
    const auto total = [&](std::uint32_t n) { return layoutStorage(pixels, n, format, keepSums, 256).total; };
    ASSERT_TRUE(fits == 0 || total(fits) <= bytes);
    ASSERT_TRUE(fits == most || total(fits + 1) > bytes);
  }
  EXPECT_EQ(nodeCapacityFor(~0ULL, 1, VITRAIL_FORMAT_STANDARD, 1, true, 256), 0xe0000000U);
  EXPECT_EQ(nodeCapacityFor(0, 1, VITRAIL_FORMAT_STANDARD, 1, true, 256), 0U);
}

NodeWords node(const NodeCoding& coding, const Fragment& fragment) { return packNode(coding, fragment).value(); }

void expectColor(const Color& got, const Color& expected) {
  for (unsigned i = 0; i < 4; ++i) EXPECT_NEAR(got[i], expected[i], 1e-12) << "channel " << i;
}

TEST(ReferenceResolve, TwoLayersByHand) {
  // Half red at 0.25 in front of half green at 0.75 over blue: 128/255 is the stored half.
  const double a = 128.0 / 255.0;
  const std::array<Color, 1> blue = {Color{0.0, 0.0, 1.0, 1.0}};
  for (const bool nearestIsOne : {false, true}) {
    PixelList pixel;
    pixel.coding.nearestIsOne = nearestIsOne;
    const NodeWords red = node(pixel.coding, {{1.0, 0.0, 0.0, 0.5}, 0.25F});
    const NodeWords green = node(pixel.coding, {{0.0, 1.0, 0.0, 0.5}, 0.75F});
    for (const auto& list : {std::vector{red, green}, std::vector{green, red}}) {
      pixel.nodes = list;
      const double front = a;
      const double back = (1 - a) * a;
      expectColor(resolvePixel(pixel, blue),
                  {nearestIsOne ? back : front, nearestIsOne ? front : back, (1 - a) * (1 - a), 1.0});
    }
  }
}

TEST(ReferenceResolve, NothingChangesNothing) {
  const std::array<Color, 1> behind = {Color{0.1, 0.2, 0.3, 0.4}};
  expectColor(resolvePixel({}, behind), behind[0]);
}

// hdr at alpha 1/3 = 21845/65535, which 16 bits hold exactly.
TEST(ReferenceResolve, EveryBlendModeByHand) {
  const double a = 1.0 / 3.0;
  const Color d = {0.5, 0.25, 1.0, 0.75};
  const auto resolve = [&](std::uint32_t blend) {
    PixelList pixel;
    pixel.coding.format = VITRAIL_FORMAT_HDR;
    pixel.nodes = {node(pixel.coding, {{4.0, 0.5, 0.0, a}, 0.5F, blend, 1})};
    return resolvePixel(pixel, std::span(&d, 1));
  };
  expectColor(resolve(VITRAIL_OVER), {4 * a + d[0] * 2 * a, 0.5 * a + d[1] * 2 * a, d[2] * 2 * a, a + d[3] * 2 * a});
  expectColor(resolve(VITRAIL_PREMULTIPLIED), {4 + d[0] * 2 * a, 0.5 + d[1] * 2 * a, d[2] * 2 * a, a + d[3] * 2 * a});
  expectColor(resolve(VITRAIL_ADDITIVE), {4 * a + d[0], 0.5 * a + d[1], d[2], d[3]});
  expectColor(resolve(VITRAIL_MULTIPLY), {(2 * a + 4 * a) * d[0], (2 * a + 0.5 * a) * d[1], 2 * a * d[2], d[3]});
}

TEST(ReferenceResolve, EachSampleBlendsWhatCoversIt) {
  PixelList pixel;
  pixel.coding.samples = 4;
  const Fragment red = {{1.0, 0.0, 0.0, 1.0}, 0.2F, VITRAIL_OVER, 0x3};
  const Fragment green = {{0.0, 1.0, 0.0, 1.0}, 0.6F, VITRAIL_OVER, 0x6};
  pixel.nodes = {node(pixel.coding, green), node(pixel.coding, red)};
  const std::array<Color, 4> behind = {Color{}, Color{}, Color{}, Color{0.0, 0.0, 1.0, 1.0}};
  expectColor(resolvePixel(pixel, behind), {0.5, 0.25, 0.25, 1.0});
  // The opaque depth hides red nowhere, green where it is nearer than it, not where it is as near.
  const std::array<float, 4> opaque = {0.2F, 0.3F, 0.6F, 0.0F};
  pixel.opaqueDepth = opaque;
  expectColor(resolvePixel(pixel, behind), {0.5, 0.25, 0.25, 1.0});
  const std::array<float, 4> nearer = {0.2F, 0.1F, 0.5999F, 0.0F};
  pixel.opaqueDepth = nearer;
  expectColor(resolvePixel(pixel, behind), {0.25, 0.0, 0.25, 0.5});
}

// A bound of one: the second and the third layer become their weighted average, with the right transmittance.
TEST(ReferenceResolve, LayersBeyondTheBoundAreAveraged) {
  PixelList pixel;
  pixel.coding.format = VITRAIL_FORMAT_HDR;
  const double a = 1.0 / 3.0;
  pixel.nodes = {node(pixel.coding, {{0.0, 0.0, 1.0, 1.0 / 5.0}, 0.9F}), node(pixel.coding, {{0.0, 1.0, 0.0, a}, 0.8F}),
                 node(pixel.coding, {{1.0, 0.0, 0.0, a}, 0.1F})};
  const Blended exact = resolveSample(pixel, 0);
  expectColor(exact.color, {a, 2.0 / 3 * a, 4.0 / 9 / 5, 1 - 4.0 / 9 * 4 / 5});
  pixel.maxLayers = 1;
  const Blended bounded = resolveSample(pixel, 0);
  const double opacity = 1 - 2.0 / 3 * 4 / 5;
  const double share = opacity / (1.0 / 3 + 1.0 / 5);
  expectColor(bounded.color, {a, 2.0 / 3 * share / 3, 2.0 / 3 * share / 5, 1 - 4.0 / 9 * 4 / 5});
  expectColor(bounded.transmittance, exact.transmittance);
  pixel.maxLayers = 3;
  expectColor(resolveSample(pixel, 0).color, exact.color);
  pixel.maxLayers = 2; // the last one alone is its own average
  expectColor(resolveSample(pixel, 0).color, exact.color);
}

TEST(ReferenceResolve, TheAverageOfOtherModes) {
  const std::array<Fragment, 2> lights = {Fragment{{1.0, 0.0, 0.0, 0.5}, 0.0F, VITRAIL_ADDITIVE, 1},
                                          Fragment{{0.0, 1.0, 0.0, 1.0}, 0.0F, VITRAIL_MULTIPLY, 1}};
  const Blended sum = weightedAverage(lights);
  expectColor(sum.color, {0.5, 0.0, 0.0, 0.0});
  expectColor(sum.transmittance, {0.0, 1.0, 0.0, 1.0});
}

} // namespace
} // namespace vitrail::tests
