// Plans of tiles through their public face: what they refuse, with the reason in the log.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <vitrail/vitrail.hpp>

namespace vitrail::tests {
namespace {

class TilePlanTest : public ::testing::Test {
 protected:
  TilePlanTest() {
    desc_.width = 640;
    desc_.height = 480;
    desc_.memoryBudget = 64 << 10;
    desc_.limits.memoryBytes = 1 << 30;
    desc_.limits.alignment = 256;
    desc_.limits.nodeCapacity = 1 << 24;
    desc_.limits.areaPixels = 1 << 24;
    desc_.log = [](VitrailLogSeverity severity, const char* message, void* lines) {
      EXPECT_EQ(severity, VITRAIL_LOG_ERROR);
      static_cast<std::vector<std::string>*>(lines)->emplace_back(message);
    };
    desc_.logUser = &lines_;
  }

  // The log has one line since the last look, with that word.
  void expectOneLine(const std::string& word) {
    ASSERT_EQ(lines_.size(), 1U) << word;
    EXPECT_NE(lines_[0].find(word), std::string::npos) << lines_[0];
    lines_.clear();
  }

  void expectRefused(const VitrailTilePlanDesc& desc, VitrailResult code, const std::string& word) {
    TilePlan plan;
    EXPECT_EQ(TilePlan::create(desc, plan), code) << word;
    EXPECT_FALSE(plan) << word;
    expectOneLine(word);
  }

  VitrailTilePlanDesc desc_{};
  std::vector<std::string> lines_;
};

TEST_F(TilePlanTest, WrongFieldsAreRefused) {
  TilePlan plan;
  EXPECT_EQ(TilePlan::create(desc_, plan), VITRAIL_SUCCESS);
  EXPECT_TRUE(lines_.empty());
  VitrailTilePlanDesc desc = desc_;
  desc.next = &desc;
  expectRefused(desc, VITRAIL_ERROR_INVALID, "next");
  desc = desc_;
  desc.width = 0;
  expectRefused(desc, VITRAIL_ERROR_INVALID, "extent");
  desc = desc_;
  desc.limits.nodeCapacity = 0;
  expectRefused(desc, VITRAIL_ERROR_INVALID, "limits");
  desc = desc_;
  desc.nodeFormat = static_cast<VitrailNodeFormat>(7);
  expectRefused(desc, VITRAIL_ERROR_INVALID, "nodeFormat");
  desc = desc_;
  desc.samples = 3;
  expectRefused(desc, VITRAIL_ERROR_FORMAT, "samples");
  desc = desc_;
  desc.nodeFormat = VITRAIL_NODE_COMPACT;
  desc.samples = 8;
  expectRefused(desc, VITRAIL_ERROR_FORMAT, "samples");
  desc = desc_;
  desc.boundsCount = 1;
  expectRefused(desc, VITRAIL_ERROR_INVALID, "bounds");
  desc = desc_;
  desc.memoryBudget = 1000;
  expectRefused(desc, VITRAIL_ERROR_OUT_OF_MEMORY, "memoryBudget");
}

TEST_F(TilePlanTest, APixelThatFitsNoBudgetIsAnErrorWithTheBytes) {
  desc_.width = 1;
  desc_.height = 1;
  TilePlan plan;
  ASSERT_EQ(TilePlan::create(desc_, plan), VITRAIL_SUCCESS);
  VitrailRect tile{};
  ASSERT_TRUE(plan.next(tile));
  VitrailStats stats{};
  stats.nodeCapacity = 4000;
  stats.fragmentsRequested = 100000;
  stats.fragmentsStored = 4000;
  stats.fragmentsMissing = 96000;
  EXPECT_EQ(plan.finish(stats), VITRAIL_ERROR_OUT_OF_MEMORY);
  expectOneLine("100000");
}

// What no splitting mends is no tile that overflowed, and none that is done.
TEST_F(TilePlanTest, TilesThatWentWrongOtherwiseAreRefused) {
  TilePlan plan;
  ASSERT_EQ(TilePlan::create(desc_, plan), VITRAIL_SUCCESS);
  VitrailRect tile{};
  ASSERT_TRUE(plan.next(tile));
  VitrailStats stats{};
  stats.nodeCapacity = 4000;
  stats.misused = 1;
  EXPECT_EQ(plan.finish(stats), VITRAIL_ERROR_INVALID);
  expectOneLine("recorded wrongly");
  stats.misused = 0;
  stats.fragmentsRequested = 10;
  stats.fragmentsMissing = 10;
  EXPECT_EQ(plan.finish(stats), VITRAIL_ERROR_INVALID);
  expectOneLine("suit");
}

// A pool whose nodes carry words has fewer of them in the same bytes.
TEST_F(TilePlanTest, WordsTakeOfTheDevicesLimit) {
  desc_.memoryBudget = 1 << 30;
  desc_.limits.nodeCapacity = 120000;
  desc_.userWords = 1;
  TilePlan plan;
  ASSERT_EQ(TilePlan::create(desc_, plan), VITRAIL_SUCCESS);
  EXPECT_EQ(plan.nodeCapacity(), 90000U);
}

TEST_F(TilePlanTest, NullArgumentsAreSafe) {
  VitrailTilePlan plan = nullptr;
  EXPECT_EQ(vitrailCreateTilePlan(nullptr, &plan), VITRAIL_ERROR_INVALID);
  EXPECT_EQ(vitrailCreateTilePlan(&desc_, nullptr), VITRAIL_ERROR_INVALID);
  expectOneLine("null");
  EXPECT_EQ(vitrailTilePlanNodeCapacity(nullptr), 0U);
  EXPECT_EQ(vitrailTilePlanAreaPixels(nullptr), 0U);
  VitrailRect tile = {1, 2, 3, 4};
  EXPECT_EQ(vitrailNextTile(nullptr, &tile), 0U);
  EXPECT_EQ(tile.width, 0U);
  const VitrailStats stats{};
  EXPECT_EQ(vitrailFinishTile(nullptr, &stats), VITRAIL_ERROR_INVALID);
  vitrailDestroyTilePlan(nullptr);
  ASSERT_EQ(vitrailCreateTilePlan(&desc_, &plan), VITRAIL_SUCCESS);
  EXPECT_EQ(vitrailNextTile(plan, nullptr), 0U);
  EXPECT_EQ(vitrailFinishTile(plan, nullptr), VITRAIL_ERROR_INVALID);
  expectOneLine("stats");
  vitrailDestroyTilePlan(plan);
  vitrailProjectBounds(1, nullptr, 64, 64, nullptr);
  EXPECT_EQ(vitrailNodePoolSize(static_cast<VitrailNodeFormat>(9), 10), 0U);
}

} // namespace
} // namespace vitrail::tests
