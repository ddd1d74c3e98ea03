// Where the library's memory comes from and how it follows what frames need: budgets, resizing in flight, pools reached
// by address.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "expected.h"

namespace vitrail::tests {
namespace {

constexpr std::uint64_t kMebibyte = 1 << 20;

class MemoryTest : public BackendTest {};
VITRAIL_ON_EVERY_BACKEND(MemoryTest);

TEST_P(MemoryTest, ThePoolGrowsTowardsItsBudgetUntilFramesAreExact) {
  for (const VitrailOverflow overflow : {VITRAIL_OVERFLOW_APPROXIMATE, VITRAIL_OVERFLOW_SKIP}) {
    HostDesc desc = squareHost();
    desc.memoryBudget = 2 * kMebibyte;
    desc.capacity = 1000;
    desc.overflow = overflow;
    const auto host = makeHost(desc);
    const std::vector<Point> points = manyLists(desc, 20, 1);
    const std::vector<Point> more = manyLists(desc, 40, 2);
    for (const std::vector<Point>* scene : {&points, &more}) {
      const Expected expected = expectedFrame(desc, *scene);
      EXPECT_EQ(host->draw(*scene).stats.complete, 0U);
      PointResult result;
      for (int frame = 0; frame < 3; ++frame) result = host->draw(*scene);
      EXPECT_EQ(result.stats.complete, 1U);
      EXPECT_EQ(result.stats.fragmentsStored, scene->size());
      EXPECT_LT(largestError(result.pixels, expected.pixels), kTolerance);
      for (int frame = 0; frame < 3; ++frame) host->draw({}); // old pools are let go
      EXPECT_LE(host->memory().totalBytes, desc.memoryBudget);
    }
  }
}

// A host reads a frame's statistics when it records the one that takes over its slot, and that one has a larger pool.
TEST_P(MemoryTest, StatisticsKnowThePoolOfTheirFrame) {
  HostDesc desc = squareHost();
  desc.memoryBudget = 2 * kMebibyte;
  desc.capacity = 1000;
  const auto host = makeHost(desc);
  const std::vector<Point> points = manyLists(desc, 20, 1);
  const VitrailStats drawn = host->draw(points).stats; // frame 0 of slot 0
  EXPECT_GT(drawn.fragmentsMissing, 0U);
  EXPECT_EQ(host->draw(points).stats.complete, 1U);
  host->drop(points); // frame 2 of slot 0, as far as the host has recorded
  const std::optional<VitrailStats> stats = host->stats(0);
  ASSERT_TRUE(stats);
  EXPECT_EQ(stats->nodeCapacity, 1000U);
  EXPECT_EQ(stats->fragmentsStored, 1000U);
  EXPECT_EQ(stats->fragmentsMissing, drawn.fragmentsMissing);
  EXPECT_EQ(stats->complete, 0U);
}

TEST_P(MemoryTest, AFrameBeyondTheBudgetStaysApproximateAndStill) {
  HostDesc desc = squareHost();
  desc.memoryBudget = kMebibyte / 2;
  const auto host = makeHost(desc);
  const std::vector<Point> points = manyLists(desc, 60, 3);
  for (int frame = 0; frame < 3; ++frame) host->draw(points);
  const PointResult settled = host->draw(points);
  EXPECT_EQ(settled.stats.complete, 0U);
  EXPECT_EQ(settled.stats.fragmentsRequested, points.size());
  EXPECT_TRUE(host->draw(ordered(points, Order::Shuffled)).pixels == settled.pixels);
  EXPECT_LE(host->memory().totalBytes, desc.memoryBudget);
}

TEST_P(MemoryTest, ThePoolShrinksWhenLittleIsNeededForLong) {
  HostDesc desc = squareHost();
  desc.memoryBudget = 4 * kMebibyte;
  desc.capacity = 200000;
  const auto host = makeHost(desc);
  const std::vector<Point> few = manyLists(desc, 2, 4);
  const std::uint32_t large = host->memory().nodeCapacity;
  EXPECT_EQ(large, 200000U);
  for (int frame = 0; frame < 115; ++frame) host->draw({few.data(), 100});
  EXPECT_EQ(host->memory().nodeCapacity, large);
  for (int frame = 0; frame < 15; ++frame) host->draw({few.data(), 100});
  EXPECT_LT(host->memory().nodeCapacity, large / 10);
  const PointResult result = host->draw({few.data(), 100});
  EXPECT_EQ(result.stats.complete, 1U);
  EXPECT_LT(largestError(result.pixels, expectedFrame(desc, {few.data(), 100}).pixels), kTolerance);
}

// The first frame is recorded but not submitted when the target gets another size; both are submitted at once.
TEST_P(MemoryTest, ATargetIsResizedWhileFramesAreInFlight) {
  for (const std::uint32_t samples : sampleCounts(features())) {
    for (const Way& way : everyWay(features(), samples)) {
      if (way.stencilMark) continue;
      SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name);
      HostDesc desc = squareHost();
      desc.samples = samples;
      apply(way, desc);
      HostDesc resized = desc;
      desc.memoryBudget = 8 * kMebibyte;
      const auto host = makeHost(desc);
      std::vector<Point> before = manyLists(desc, 6, 5);
      host->draw(before); // the pool is large enough afterwards
      host->draw(before);
      for (const Extent extent : {Extent{100, 30}, Extent{20, 70}}) {
        resized.width = extent.width;
        resized.height = extent.height;
        const std::vector<Point> after = manyLists(resized, 7, 6);
        const auto [first, second] = host->drawAcrossResize(before, extent, after);
        EXPECT_LT(largestError(first.pixels, expectedFrame(desc, before).pixels), kTolerance);
        EXPECT_EQ(second.stats.complete, 1U);
        EXPECT_LT(largestError(second.pixels, expectedFrame(resized, after).pixels), kTolerance);
        before = after;
        desc.width = extent.width;
        desc.height = extent.height;
      }
      EXPECT_LT(largestError(host->draw(before).pixels, expectedFrame(resized, before).pixels), kTolerance);
    }
  }
}

TEST_P(MemoryTest, AFixedPoolGrowsWithAResize) {
  HostDesc desc = squareHost();
  const std::vector<Point> before = manyLists(desc, 6, 5);
  desc.capacity = static_cast<std::uint32_t>(before.size());
  HostDesc larger = desc;
  larger.width = 128;
  larger.height = 128;
  const std::vector<Point> after = manyLists(larger, 6, 5);
  const auto needed = static_cast<std::uint32_t>(after.size());
  for (const std::uint32_t capacity : {0U, needed}) {
    const auto host = makeHost(desc);
    const auto [first, second] = host->drawAcrossResize(before, {128, 128}, after, capacity);
    EXPECT_EQ(first.stats.complete, 1U);
    EXPECT_EQ(host->memory().nodeCapacity, capacity == 0 ? desc.capacity : needed);
    EXPECT_EQ(second.stats.complete, capacity == 0 ? 0U : 1U);
    if (capacity == 0) continue;
    EXPECT_LT(largestError(second.pixels, expectedFrame(larger, after).pixels), kTolerance);
  }
}

// A window that is made larger has as many layers on each pixel as before: there is room for them at once.
TEST_P(MemoryTest, UnderABudgetThePoolFollowsTheExtent) {
  HostDesc desc = squareHost();
  desc.memoryBudget = 32 * kMebibyte;
  HostDesc larger = desc;
  larger.width = 200;
  larger.height = 150;
  const std::vector<Point> before = manyLists(desc, 12, 5);
  const std::vector<Point> after = manyLists(larger, 12, 6);
  const auto host = makeHost(desc);
  for (int frame = 0; frame < 3; ++frame) host->draw(before);
  const auto [first, second] = host->drawAcrossResize(before, {larger.width, larger.height}, after);
  EXPECT_EQ(first.stats.complete, 1U);
  EXPECT_EQ(second.stats.complete, 1U);
  EXPECT_LE(host->memory().totalBytes - host->memory().retiredBytes, desc.memoryBudget);
}

TEST_P(MemoryTest, PoolsAreReachedByAddressToo) {
  if (!features().addresses) GTEST_SKIP() << "this device has no buffer addresses";
  for (const std::uint32_t samples : sampleCounts(features())) {
    for (const Way& way : everyWay(features(), samples)) {
      for (const VitrailNodeFormat format : nodeFormats(samples)) {
        if (way.stencilMark ||
            (format != VITRAIL_NODE_STANDARD && (samples > 1 || way.resolve != VITRAIL_RESOLVE_COMPUTE))) {
          continue;
        }
        SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name + ", format " + std::to_string(format));
        HostDesc desc;
        desc.addresses = true;
        desc.samples = samples;
        desc.nodes = format;
        apply(way, desc);
        const std::vector<Point> points = randomLists(desc, {0, 1, 5, 16, 17, 33, 100}, 9);
        desc.capacity = static_cast<std::uint32_t>(points.size());
        const auto host = makeHost(desc);
        const PointResult result = host->draw(points);
        EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), kTolerance);
        EXPECT_EQ(result.stats.complete, 1U);
        desc.capacity -= 10; // beyond the pool's end is nobody's
        EXPECT_EQ(draw(desc, points).stats.fragmentsMissing, 10U);
      }
    }
  }
}

// A shader that reaches pools in one way and a target that has the other: it works, or its fragments are missing.
TEST_P(MemoryTest, ShadersThatDoNotReachThePoolAreCounted) {
  if (!features().addresses) GTEST_SKIP() << "this device has no buffer addresses";
  for (const bool byAddress : {false, true}) {
    for (const VitrailListBuild listBuild : {VITRAIL_LIST_BUILD_FRAGMENT, VITRAIL_LIST_BUILD_COMPUTE}) {
      for (const VitrailOverflow overflow : {VITRAIL_OVERFLOW_APPROXIMATE, VITRAIL_OVERFLOW_SKIP}) {
        SCOPED_TRACE(std::string(byAddress ? "by binding" : "by address") + ", list build " +
                     std::to_string(listBuild) + ", overflow " + std::to_string(overflow));
        HostDesc desc;
        desc.listBuild = listBuild;
        desc.overflow = overflow;
        desc.addresses = byAddress;
        desc.shaderByAddress = !byAddress;
        desc.behind = {0.5F, 0.25F, 0.75F, 1.0F};
        const std::vector<Point> points = randomLists(desc, {1, 2, 40}, 9);
        desc.capacity = static_cast<std::uint32_t>(points.size());
        const PointResult result = draw(desc, points);
        EXPECT_EQ(result.stats.fragmentsRequested, points.size());
        if (result.stats.complete == 1) {
          EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), kTolerance);
        } else {
          EXPECT_EQ(result.stats.fragmentsMissing, points.size());
        }
        EXPECT_EQ(result.stats.complete, byAddress ? 1U : 0U); // a small pool is all of it in its binding
      }
    }
  }
}

// A pool that has more than a binding reaches: shaders that look there count as missing, others draw.
TEST_P(MemoryTest, PoolsBeyondABindingAreReachedByAddressOnly) {
  constexpr std::uint64_t kAffordable = 512 * kMebibyte;
  if (!features().addresses) GTEST_SKIP() << "this device has no buffer addresses";
  if (features().bindingBytes > kAffordable) GTEST_SKIP() << "this device's bindings reach further than tests allocate";
  for (const VitrailListBuild listBuild : {VITRAIL_LIST_BUILD_FRAGMENT, VITRAIL_LIST_BUILD_COMPUTE}) {
    for (const bool specialized : {false, true}) {
      for (const bool byAddress : {true, false}) {
        SCOPED_TRACE("list build " + std::to_string(listBuild) + (specialized ? ", specialized" : "") +
                     (byAddress ? ", by address" : ", by binding"));
        HostDesc desc;
        desc.listBuild = listBuild;
        desc.specialized = specialized;
        desc.addresses = true;
        desc.shaderByAddress = byAddress;
        desc.overflow = VITRAIL_OVERFLOW_SKIP;
        desc.behind = {0.5F, 0.25F, 0.75F, 1.0F};
        const std::vector<Point> points = randomLists(desc, {1, 2, 40}, 9);
        desc.capacity = static_cast<std::uint32_t>(features().bindingBytes / vitrailNodePoolSize(desc.nodes, 1)) + 1000;
        const PointResult result = draw(desc, points);
        EXPECT_EQ(result.stats.fragmentsRequested, points.size());
        EXPECT_EQ(result.stats.fragmentsMissing, byAddress ? 0U : points.size());
        EXPECT_EQ(result.stats.complete, byAddress ? 1U : 0U);
        const auto seen = byAddress ? points : std::vector<Point>{};
        EXPECT_LT(largestError(result.pixels, expectedFrame(desc, seen).pixels), kTolerance);
      }
    }
  }
}

TEST_P(MemoryTest, RequirementsAndReportsAgree) {
  HostDesc desc = squareHost();
  desc.capacity = 1000;
  const VitrailMemory memory = makeHost(desc)->memory();
  EXPECT_EQ(memory.nodeCapacity, 1000U);
  EXPECT_EQ(memory.nodeBytes, vitrailNodePoolSize(VITRAIL_NODE_STANDARD, 1000));
  EXPECT_EQ(memory.headBytes, 4U * 64 * 64);
  EXPECT_EQ(memory.totalBytes, memory.nodeBytes + memory.headBytes + memory.otherBytes);
  desc.overflow = VITRAIL_OVERFLOW_SKIP;
  const VitrailMemory less = makeHost(desc)->memory();
  EXPECT_NEAR(static_cast<double>(memory.totalBytes - less.totalBytes), 20.0 * 64 * 64, 512.0); // but for alignment
}

} // namespace
} // namespace vitrail::tests
