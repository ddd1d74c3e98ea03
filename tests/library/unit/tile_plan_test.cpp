// The tile planner, driven by made-up pictures: every pixel is drawn once, within the budget, in a stable order.
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "core/pool.h"
#include "core/tile_plan.h"

namespace vitrail::tests {
namespace {

using namespace layout;

// Fragments of a pixel.
using Density = std::function<std::uint64_t(std::uint32_t x, std::uint32_t y)>;

struct Outcome {
  std::vector<Rectangle> tiles; // that did not overflow
  std::size_t attempts = 0;
  bool complete = false;
  std::uint64_t bytesNeeded = 0;
};

std::uint64_t fragmentsIn(const Rectangle& tile, const Density& density) {
  std::uint64_t sum = 0;
  for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y) {
    for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) sum += density(x, y);
  }
  return sum;
}

// The memory of a tile's target.
StorageLayout storageOf(const TilePlanner& plan, const TilePlanInfo& info) {
  StorageNeeds needs;
  needs.areaPixels = plan.areaPixels();
  needs.nodeCapacity = plan.nodeCapacity();
  needs.format = info.format;
  needs.userWords = info.userWords;
  needs.alignment = info.alignment;
  return layoutStorage(needs);
}

Outcome drawTiles(const TilePlanInfo& info, const Density& density) {
  TilePlanner plan(info);
  EXPECT_GT(plan.nodeCapacity(), 0U);
  EXPECT_LE(storageOf(plan, info).total, info.memoryBudget);
  Outcome outcome;
  Rectangle tile;
  while (plan.next(tile)) {
    ++outcome.attempts;
    EXPECT_GT(tile.width, 0U);
    EXPECT_GT(tile.height, 0U);
    EXPECT_LE(std::uint64_t{tile.width} * tile.height, plan.areaPixels());
    const std::uint64_t requested = fragmentsIn(tile, density);
    const std::uint64_t missing = requested > plan.nodeCapacity() ? requested - plan.nodeCapacity() : 0;
    if (missing == 0) outcome.tiles.push_back(tile);
    if (!plan.finish(requested, missing, plan.nodeCapacity())) {
      outcome.bytesNeeded = plan.bytesNeeded();
      return outcome;
    }
  }
  outcome.complete = true;
  return outcome;
}

// Every pixel of the area is in one tile, and tiles come row by row.
void expectCover(const Rectangle& area, const std::vector<Rectangle>& tiles) {
  std::vector<int> drawn(std::size_t{area.width} * area.height);
  std::uint64_t last = 0;
  for (const Rectangle& tile : tiles) {
    ASSERT_GE(tile.x, area.x);
    ASSERT_GE(tile.y, area.y);
    ASSERT_LE(tile.x + tile.width, area.x + area.width);
    ASSERT_LE(tile.y + tile.height, area.y + area.height);
    const std::uint64_t place = std::uint64_t{tile.y} * 100000 + tile.x + 1;
    EXPECT_GT(place, last);
    last = place;
    for (std::uint32_t y = tile.y - area.y; y < tile.y - area.y + tile.height; ++y) {
      for (std::uint32_t x = tile.x - area.x; x < tile.x - area.x + tile.width; ++x) {
        ++drawn[std::size_t{y} * area.width + x];
      }
    }
  }
  for (const int count : drawn) ASSERT_EQ(count, 1);
}

TilePlanInfo planInfo(const Rectangle& area, std::uint64_t budget) {
  TilePlanInfo info;
  info.area = area;
  info.memoryBudget = budget;
  return info;
}

TEST(TilePlan, APictureThatFitsIsOneTile) {
  const TilePlanInfo info = planInfo({3, 5, 640, 360}, 64 << 20);
  const Outcome outcome = drawTiles(info, [](auto, auto) { return 2; });
  EXPECT_TRUE(outcome.complete);
  EXPECT_EQ(outcome.tiles, (std::vector{info.area}));
}

TEST(TilePlan, AnEmptyAreaHasNoTiles) {
  TilePlanner plan(planInfo({}, 1 << 20));
  Rectangle tile;
  EXPECT_FALSE(plan.next(tile));
  EXPECT_EQ(plan.areaPixels(), 1U);
}

TEST(TilePlan, EveryBudgetDrawsEveryPixelOnce) {
  const Density even = [](auto, auto) { return 8; };
  const Density lumpy = [](std::uint32_t x, std::uint32_t y) {
    return (x / 50 + y / 30) % 5 == 0 ? 150 : y > 200 && y < 206 ? 40 : 0;
  };
  const Density none = [](auto, auto) { return 0; };
  for (const Density& density : {even, lumpy, none}) {
    for (std::uint64_t budget = 64 << 10; budget <= 64 << 20; budget *= 2) {
      for (const Rectangle area : {Rectangle{0, 0, 640, 360}, Rectangle{7, 100, 3, 200}, Rectangle{0, 9, 5000, 1}}) {
        const Outcome outcome = drawTiles(planInfo(area, budget), density);
        EXPECT_TRUE(outcome.complete);
        expectCover(area, outcome.tiles);
      }
    }
  }
}

// What overflows is drawn for nothing: over an even picture that happens about once, not once a tile.
TEST(TilePlan, FewTilesAreDrawnInVain) {
  const Outcome outcome = drawTiles(planInfo({0, 0, 1920, 1080}, 4 << 20), [](auto, auto) { return 12; });
  const double nodes = 1920.0 * 1080 * 12;
  const double capacity = 0.95 * (4 << 20) / 12;
  EXPECT_LT(static_cast<double>(outcome.tiles.size()), 1.6 * nodes / capacity);
  EXPECT_LE(outcome.attempts, outcome.tiles.size() + 3);
}

TEST(TilePlan, AnExpectedCountSizesTheFirstTileAndThePool) {
  TilePlanInfo info = planInfo({0, 0, 1000, 1000}, 8 << 20);
  info.expectedFragments = 5'000'000;
  Outcome outcome = drawTiles(info, [](auto, auto) { return 5; });
  EXPECT_TRUE(outcome.complete);
  EXPECT_EQ(outcome.attempts, outcome.tiles.size()); // nothing in vain
  info.memoryBudget = 1 << 30;
  TilePlanner plan(info);
  EXPECT_EQ(plan.nodeCapacity(), 5'500'000U);
  outcome = drawTiles(info, [](auto, auto) { return 5; });
  EXPECT_EQ(outcome.attempts, 1U);
  outcome = drawTiles(info, [](auto, auto) { return 9; }); // it had more
  EXPECT_TRUE(outcome.complete);
  expectCover(info.area, outcome.tiles);
}

TEST(TilePlan, HeadsAndListsGetAQuarterAtMost) {
  for (const std::uint64_t budget : {64U << 10U, 1U << 20U, 100U << 20U}) {
    const TilePlanInfo info = planInfo({0, 0, 20000, 20000}, budget);
    const TilePlanner plan(info);
    const StorageLayout storage = storageOf(plan, info);
    EXPECT_LE(storage.nodes.offset, budget / 4);
    EXPECT_GE(4 * plan.areaPixels(), budget / 16); // and not much less than that
  }
}

TEST(TilePlan, ADeviceLimitOfThePoolHolds) {
  TilePlanInfo info = planInfo({0, 0, 64, 64}, std::uint64_t{1} << 34U);
  info.nodeCapacityLimit = 1000;
  EXPECT_EQ(TilePlanner(info).nodeCapacity(), 1000U);
  const Outcome outcome = drawTiles(info, [](auto, auto) { return 900; });
  EXPECT_EQ(outcome.tiles.size(), 4096U);
}

TEST(TilePlan, ADeviceLimitOfTheHeadPointersHolds) {
  TilePlanInfo info = planInfo({0, 0, 640, 360}, 64 << 20);
  info.areaPixelsLimit = 50000;
  EXPECT_EQ(TilePlanner(info).areaPixels(), 50000U);
  const Outcome outcome = drawTiles(info, [](auto, auto) { return 1; });
  EXPECT_EQ(outcome.tiles.size(), 5U); // of 78 rows each
  expectCover(info.area, outcome.tiles);
}

// A pixel that alone has more fragments than nodes cannot be split; the budget that is asked for then does hold it.
TEST(TilePlan, APixelThatOverflowsSaysWhatItNeeds) {
  for (const std::uint32_t format : {VITRAIL_FORMAT_STANDARD, VITRAIL_FORMAT_COMPACT, VITRAIL_FORMAT_HDR}) {
    TilePlanInfo info = planInfo({0, 0, 40, 30}, 64 << 10);
    info.format = format;
    const Density deep = [](std::uint32_t x, std::uint32_t y) { return x == 17 && y == 20 ? 1'000'000 : 3; };
    const Outcome outcome = drawTiles(info, deep);
    EXPECT_FALSE(outcome.complete);
    EXPECT_GT(outcome.bytesNeeded, 1'000'000U * nodeBytes(format));
    EXPECT_LT(outcome.bytesNeeded, 1'500'000U * nodeBytes(format));
    info.memoryBudget = outcome.bytesNeeded;
    const Outcome second = drawTiles(info, deep);
    EXPECT_TRUE(second.complete);
    expectCover(info.area, second.tiles);
  }
}

// Fragments that are missing although there were nodes (a shader of another target draws them) never fit: that ends
// too.
TEST(TilePlan, AFragmentThatNeverFitsEndsInAnError) {
  TilePlanner plan(planInfo({0, 0, 64, 64}, 1 << 20));
  Rectangle tile;
  std::size_t attempts = 0;
  bool split = true;
  while (split && attempts < 100 && plan.next(tile)) {
    ++attempts;
    split = plan.finish(1, 1, plan.nodeCapacity());
  }
  EXPECT_FALSE(split);
  EXPECT_EQ(tile, (Rectangle{0, 0, 1, 1}));
}

TEST(TilePlan, ACountBeyondAllBoundsIsSplitToPixels) {
  TilePlanner plan(planInfo({0, 0, 8, 4}, 1 << 20));
  Rectangle tile;
  std::size_t attempts = 0;
  bool split = true;
  while (split && plan.next(tile)) {
    ++attempts;
    split = plan.finish(~0ULL, ~0ULL - plan.nodeCapacity(), plan.nodeCapacity());
  }
  EXPECT_FALSE(split);
  EXPECT_EQ(tile, (Rectangle{0, 0, 1, 1}));
  EXPECT_LE(attempts, 4U);
}

} // namespace
} // namespace vitrail::tests
