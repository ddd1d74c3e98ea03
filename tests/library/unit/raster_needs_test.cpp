// How the memory of a raster follows what its frames need.
#include <gtest/gtest.h>

#include "core/raster_needs.h"

namespace vitrail::tests {
namespace {

constexpr RasterNeeds kLeast{.records = 1, .large = 1, .deep = 1, .blocks = 1, .fragments = 1, .chunks = 1};
constexpr RasterBounds kWide{.reach = 1ULL << 32U, .budget = 1ULL << 34U, .tiles = 1000, .samples = 1};

RasterNeeds withRecords(std::uint64_t records) {
  RasterNeeds needs = kLeast;
  needs.records = records;
  return needs;
}

TEST(RasterNeeds, FitWhereAllOfThemDo) {
  const RasterNeeds room{.records = 10, .large = 10, .deep = 10, .blocks = 10, .fragments = 10, .chunks = 10};
  EXPECT_TRUE(kLeast.fitInto(room));
  EXPECT_TRUE(room.fitInto(room));
  for (std::uint64_t RasterNeeds::*need : {&RasterNeeds::records, &RasterNeeds::large, &RasterNeeds::deep,
                                           &RasterNeeds::blocks, &RasterNeeds::fragments, &RasterNeeds::chunks}) {
    RasterNeeds more = room;
    ++(more.*need);
    EXPECT_FALSE(more.fitInto(room));
    EXPECT_EQ(more.most(room).*need, 11U);
  }
}

TEST(RasterNeeds, PartsAreRoundedUp) {
  const RasterNeeds needs{.records = 10, .large = 10, .deep = 1, .blocks = 9, .fragments = 8, .chunks = 0};
  const RasterNeeds part = needs.part(4);
  EXPECT_EQ(part.records, 3U);
  EXPECT_EQ(part.large, 10U); // in each
  EXPECT_EQ(part.deep, 1U);
  EXPECT_EQ(part.blocks, 3U);
  EXPECT_EQ(part.fragments, 2U);
  EXPECT_EQ(part.chunks, 0U);
}

TEST(RasterNeeds, RoomHasSomeToSpareWhereTheBudgetHas) {
  RasterNeeds next;
  EXPECT_LE(planRasterRoom(withRecords(8000), kLeast, kWide, next), 1.0);
  EXPECT_EQ(next.records, 9000U);
  EXPECT_EQ(next.deep, 1U); // there was room for one
  // None to spare: as much as is needed.
  RasterBounds bounds = kWide;
  bounds.budget = 176 * 1000 + 8000 * 37 + 7000;
  EXPECT_LE(planRasterRoom(withRecords(8000), kLeast, bounds, next), 1.0);
  EXPECT_EQ(next.records, 8000U);
  // What only earlier frames needed goes first.
  RasterNeeds had = kLeast;
  had.fragments = 10'000;
  EXPECT_LE(planRasterRoom(withRecords(8000), had, kWide, next), 1.0);
  EXPECT_EQ(next.fragments, 10'000U);
  EXPECT_LE(planRasterRoom(withRecords(8000), had, bounds, next), 1.0);
  EXPECT_EQ(next.fragments, 1U);
}

TEST(RasterNeeds, TooMuchIsSaidByHowMuch) {
  RasterBounds bounds = kWide;
  bounds.budget = 1 << 20U;
  RasterNeeds next;
  const double excess = planRasterRoom(withRecords(80'000), kLeast, bounds, next);
  EXPECT_NEAR(excess, (176.0 * 1000 + 37.0 * 80'000) / (1 << 20U), 0.01);
  EXPECT_EQ(fewerRasterRows(100, excess), 25U); // 3.0 times too much, and some for what bands share
  EXPECT_EQ(fewerRasterRows(100, 1.01), 50U);
  EXPECT_EQ(fewerRasterRows(1, 9.0), 1U);
  // What a shader reaches, and what numbers of 32 bits count, bound as well.
  bounds = kWide;
  bounds.reach = 1 << 20U;
  EXPECT_NEAR(rasterExcess(withRecords(1 << 16U), bounds), 2.0, 0.01);
  bounds.reach = bounds.budget = 1ULL << 60U;
  EXPECT_GT(rasterExcess(withRecords(4'000'000'000), bounds), 1.9);
  bounds.samples = 8; // whose masks take more than records
  bounds.reach = 64ULL << 16U;
  EXPECT_NEAR(rasterExcess(withRecords(1 << 17U), bounds), 2.0, 0.01);
}

TEST(RasterNeeds, MemoryFollowsDownAfterLong) {
  RasterLow low;
  RasterNeeds most;
  const RasterNeeds room = withRecords(1000);
  const auto note = [&](std::uint64_t records) {
    const RasterNeeds needs = withRecords(records);
    return low.note(needs, isLowRasterNeed(needs, room), most);
  };
  for (int i = 0; i < 119; ++i) EXPECT_FALSE(note(i == 50 ? 200 : 100));
  EXPECT_FALSE(note(250)); // not a quarter less
  for (int i = 0; i < 119; ++i) EXPECT_FALSE(note(i == 50 ? 200 : 100));
  EXPECT_TRUE(note(100));
  EXPECT_EQ(most.records, 200U);
  EXPECT_FALSE(note(100)); // and from the start
  RasterNeeds deep = room;
  deep.fragments = 1000;
  RasterNeeds needs = withRecords(100);
  EXPECT_TRUE(isLowRasterNeed(needs, deep));
  needs.fragments = 250;
  EXPECT_FALSE(isLowRasterNeed(needs, deep));
}

// Bands are joined where all that they need fits twice, whatever bounds them.
TEST(RasterNeeds, BandsAreJoinedWhereAllThatTheyNeedFits) {
  const RasterNeeds band{.records = 6400, .large = 100, .deep = 100, .blocks = 100, .fragments = 3200, .chunks = 100};
  const RasterNeeds joined = band.joined();
  EXPECT_EQ(joined.records, 14'400U);
  EXPECT_EQ(joined.large, 425U); // a triangle over 50 tiles in each half is large in the whole
  EXPECT_EQ(joined.deep, 225U);
  for (std::uint64_t RasterNeeds::*need : {&RasterNeeds::records, &RasterNeeds::large, &RasterNeeds::deep,
                                           &RasterNeeds::blocks, &RasterNeeds::fragments, &RasterNeeds::chunks}) {
    RasterNeeds most = kLeast;
    most.*need = 100'000;
    RasterNeeds next;
    RasterBounds bounds = kWide;
    RasterNeeds twice = most.joined();
    bounds.budget = 1;
    const double bytes = rasterExcess(twice, bounds); // of one byte
    bounds.budget = static_cast<std::uint64_t>(2.0 * bytes) + 100;
    ASSERT_TRUE(planJoinedBands(most, kLeast, bounds, next));
    EXPECT_TRUE(most.joined().fitInto(next));
    bounds.budget = static_cast<std::uint64_t>(1.9 * bytes) - 100 * 24;
    EXPECT_FALSE(planJoinedBands(most, kLeast, bounds, next));
  }
}

} // namespace
} // namespace vitrail::tests
