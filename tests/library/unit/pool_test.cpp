// Pool sizes, against values worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/pool.h"

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
          StorageNeeds needs;
          needs.areaPixels = pixels;
          needs.nodeCapacity = capacity;
          needs.format = VITRAIL_FORMAT_HDR;
          needs.keepSums = keepSums;
          needs.userWords = capacity % 2 == 1;
          needs.copyLayers = pixels % 1000;
          needs.alignment = alignment;
          const StorageLayout storage = layoutStorage(needs);
          std::uint64_t end = 0;
          for (const StoragePart& part : {storage.parameters, storage.control, storage.heads, storage.mediumLists,
                                          storage.longLists, storage.sums, storage.copy, storage.nodes}) {
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
    StorageNeeds needs;
    needs.format = static_cast<std::uint32_t>(random() % 3);
    const std::uint32_t samples = 1U << (random() % 4);
    needs.areaPixels = static_cast<std::uint32_t>(random() >> (32 + random() % 32));
    const std::uint64_t bytes = random() >> (random() % 50 + 14);
    needs.keepSums = random() % 2 == 0;
    needs.userWords = random() % 2 == 0;
    const std::uint32_t most = maxNodeIndexCount(needs.format, samples);
    const std::uint32_t fits = nodeCapacityFor(bytes, needs, samples);
    ASSERT_LE(fits, most);
    const auto total = [&](std::uint32_t n) {
      needs.nodeCapacity = n;
      return layoutStorage(needs).total;
    };
    ASSERT_TRUE(fits == 0 || total(fits) <= bytes);
    ASSERT_TRUE(fits == most || total(fits + 1) > bytes);
  }
  StorageNeeds pixel;
  pixel.areaPixels = 1;
  EXPECT_EQ(nodeCapacityFor(~0ULL, pixel, 1), 0xe0000000U);
  EXPECT_EQ(nodeCapacityFor(0, pixel, 1), 0U);
}

} // namespace
} // namespace vitrail::tests
