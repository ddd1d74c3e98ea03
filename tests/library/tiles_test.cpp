// Pictures in tiles: whatever the memory budget, the same bits; and no more tiles than it takes.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include <vitrail/vitrail.hpp>

#include "../thorough.h"
#include "expected.h"

namespace vitrail::tests {
namespace {

constexpr std::uint64_t kTileMebibyte = 1 << 20;

class TilesTest : public BackendTest {};
VITRAIL_ON_EVERY_BACKEND(TilesTest);

// Draws in the tiles of a plan. Counts the tiles that were drawn, in vain or not.
std::vector<FloatColor> drawTiles(Backend& backend, HostDesc desc, VitrailTilePlanDesc planDesc,
                                  std::span<const Point> points, std::size_t& attempts) {
  planDesc.width = desc.width;
  planDesc.height = desc.height;
  planDesc.nodeFormat = desc.nodes;
  planDesc.samples = desc.samples;
  planDesc.limits = backend.tileLimits(desc.nodes, desc.samples);
  TilePlan plan;
  EXPECT_EQ(TilePlan::create(planDesc, plan), VITRAIL_SUCCESS);
  desc.capacity = plan.nodeCapacity();
  desc.areaPixels = plan.areaPixels();
  desc.overflow = VITRAIL_OVERFLOW_SKIP;
  const auto host = backend.makeHost(desc);
  EXPECT_LE(host->memory().nodeBytes + host->memory().headBytes, planDesc.memoryBudget);
  const PointResult result = host->drawAreas(points, [&](const VitrailStats* last, VitrailRect& area) {
    if (last != nullptr) {
      ++attempts;
      EXPECT_EQ(plan.finish(*last), VITRAIL_SUCCESS);
    }
    return plan.next(area);
  });
  return result.pixels;
}

TEST_P(TilesTest, EveryBudgetGivesTheSameBits) {
  for (const std::uint32_t samples : sampleCounts(features())) {
    for (const Way& way : everyWay(features(), samples)) {
      if (samples > 1 && way.stencilMark) continue;
      SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name);
      HostDesc desc = squareHost();
      desc.samples = samples;
      apply(way, desc);
      const std::vector<Point> points = manyLists(desc, 20, 7);
      desc.capacity = static_cast<std::uint32_t>(points.size());
      const std::vector<FloatColor> whole = draw(desc, points).pixels;
      std::size_t attempts = 0;
      for (const std::uint64_t budget :
           {std::uint64_t{64 << 10}, kTileMebibyte / 4, kTileMebibyte, 4 * kTileMebibyte}) {
        VitrailTilePlanDesc plan{};
        plan.memoryBudget = budget;
        if (budget >= kTileMebibyte / 4 && budget <= kTileMebibyte && !isThorough()) continue;
        attempts = 0;
        EXPECT_TRUE(drawTiles(backend(), desc, plan, points, attempts) == whole) << budget << " bytes";
        if (way.resolve == VITRAIL_RESOLVE_FRAGMENT && budget == 64 << 10) break; // one budget shows it
      }
      EXPECT_TRUE(way.resolve == VITRAIL_RESOLVE_FRAGMENT || attempts == 1) << "the last budget holds it all";
    }
  }
}

// Only the rectangle around the bounds is drawn, and a known count saves drawing in vain.
TEST_P(TilesTest, BoundsAndCountsMakeFewerTiles) {
  HostDesc desc = squareHost();
  std::vector<Point> points = manyLists(desc, 50, 8);
  std::erase_if(points, [](const Point& p) { return p.x < 20 || p.x >= 40 || p.y < 10 || p.y >= 50; });
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const std::vector<FloatColor> whole = draw(desc, points).pixels;
  VitrailBounds bounds{};
  bounds.min[0] = 20.0F / 32.0F - 1.0F;
  bounds.max[0] = 40.0F / 32.0F - 1.0F;
  bounds.min[1] = 10.0F / 32.0F - 1.0F;
  bounds.max[1] = 50.0F / 32.0F - 1.0F;
  bounds.max[2] = 1.0F;
  for (int i = 0; i < 4; ++i) bounds.clipFromBox[5 * i] = 1.0F;
  VitrailRect area{};
  vitrailProjectBounds(1, &bounds, 64, 64, &area);
  EXPECT_EQ(area.x, 18U);
  EXPECT_EQ(area.y, 8U);
  EXPECT_EQ(area.width, 24U);
  EXPECT_EQ(area.height, 44U);
  VitrailTilePlanDesc plan{};
  plan.memoryBudget = 64 << 10;
  plan.boundsCount = 1;
  plan.bounds = &bounds;
  std::size_t unknown = 0;
  EXPECT_TRUE(drawTiles(backend(), desc, plan, points, unknown) == whole);
  plan.expectedFragments = points.size();
  std::size_t known = 0;
  EXPECT_TRUE(drawTiles(backend(), desc, plan, points, known) == whole);
  EXPECT_LT(known, unknown);
  EXPECT_GT(known, 1U);
}

} // namespace
} // namespace vitrail::tests
