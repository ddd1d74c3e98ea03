// Blocks with many rows shade only those of which something shows. The picture must not depend on it.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "scene.h"

namespace vitrail::tests::raster {
namespace {

constexpr std::uint32_t kHiddenSide = 64;

// Panes over the whole picture, each a draw with a shade function that counts.
struct Pane {
  std::vector<Position> corners;
  float alpha = 0.0F;
  std::uint64_t* shaded = nullptr;
  bool isHole = false;
  float leastAlpha = 0.0F;
};

void shadePane(void* user, VitrailCpuFragments* fragments) {
  const Pane& pane = *static_cast<const Pane*>(user);
  *pane.shaded += static_cast<std::uint64_t>(__builtin_popcount(fragments->mask));
  for (std::size_t lane = 0; lane < VITRAIL_CPU_LANES; ++lane) {
    for (std::size_t c = 0; c < 3; ++c) fragments->color[c][lane] = 0.5F;
    fragments->color[3][lane] = pane.alpha;
  }
  if (pane.isHole) fragments->discarded = fragments->mask;
}

struct Panes {
  std::vector<Pane> panes;
  std::uint64_t shaded = 0;

  Panes(std::uint32_t count, float alpha) : panes(count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const float depth = (static_cast<float>(i) + 0.5F) / static_cast<float>(count);
      const auto at = [&](double x, double y) { return inPixels(kHiddenSide, kHiddenSide, x, y, depth); };
      panes[i] = {{at(0, 0), at(kHiddenSide, 0), at(0, kHiddenSide), at(kHiddenSide, 0), at(kHiddenSide, kHiddenSide),
                   at(0, kHiddenSide)},
                  alpha,
                  &shaded};
    }
  }

  VitrailStats draw(VitrailCpuInstructions instructions, const std::vector<std::size_t>& order, Picture& picture) {
    shaded = 0;
    std::vector<VitrailCpuDraw> draws;
    for (const std::size_t i : order) {
      VitrailCpuDraw draw = drawOf(panes[i].corners);
      draw.shade = shadePane;
      draw.shadeUser = &panes[i];
      draw.leastAlpha = panes[i].leastAlpha;
      if (draw.leastAlpha == 0.0F) draw.shadeFlags = VITRAIL_CPU_SHADE_DISCARD;
      draw.brightest = 1.0F;
      draws.push_back(draw);
    }
    Raster raster(instructions);
    VitrailStats stats{};
    EXPECT_EQ(raster.render(picture.frame(), draws, &stats), VITRAIL_SUCCESS);
    return stats;
  }
};

std::vector<std::size_t> inOrder(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  return order;
}

// Without surfaces that send light and need not hide any: with one of those nothing is left out.
void keepBounded(Scene& scene) {
  for (const auto& each : scene.draws) {
    VitrailCpuDraw& draw = each->desc;
    const bool isUnknown = draw.blend == VITRAIL_BLEND_PREMULTIPLIED && draw.shade != nullptr;
    if (draw.blend != VITRAIL_BLEND_ADDITIVE && !isUnknown) continue;
    draw.blend = VITRAIL_BLEND_OVER;
    draw.shadeFlags &= ~std::uint32_t{VITRAIL_CPU_SHADE_FILTER};
  }
}

class HiddenTest : public testing::TestWithParam<VitrailCpuInstructions> {};

TEST_P(HiddenTest, IsNotShadedInWhateverOrderItComes) {
  constexpr std::uint32_t kPanes = 48;
  Panes panes(kPanes, 0.9F);
  std::vector<std::size_t> order = inOrder(kPanes);
  Picture first(kHiddenSide, kHiddenSide);
  panes.draw(GetParam(), order, first);
  for (int round = 0; round < 3; ++round) {
    Picture picture(kHiddenSide, kHiddenSide);
    const VitrailStats stats = panes.draw(GetParam(), order, picture);
    EXPECT_EQ(stats.fragmentsRequested, std::uint64_t{kPanes} * kHiddenSide * kHiddenSide);
    EXPECT_EQ(stats.layersMax, kPanes);
    // 0.1^4 is less than 0.000106.
    EXPECT_EQ(panes.shaded, std::uint64_t{4} * kHiddenSide * kHiddenSide) << "round " << round;
    EXPECT_NEAR(picture.at(20, 30)[0], 0.5, 1e-4);
    EXPECT_TRUE(picture.pixels == first.pixels) << "round " << round;
    if (round == 0) std::reverse(order.begin(), order.end());
    if (round == 1) std::shuffle(order.begin(), order.end(), Random(3).engine());
  }
}

// What is hidden is then known without shading, whatever came first.
TEST_P(HiddenTest, WhereTheLeastAlphaIsToldLittleThatIsHiddenIsShaded) {
  constexpr std::uint32_t kPanes = 400;
  Panes panes(kPanes, 0.9F);
  std::vector<std::size_t> order = inOrder(kPanes);
  Picture first(kHiddenSide, kHiddenSide);
  panes.draw(GetParam(), order, first);
  for (Pane& pane : panes.panes) pane.leastAlpha = 0.9F;
  for (int round = 0; round < 2; ++round) {
    std::reverse(order.begin(), order.end());
    Picture picture(kHiddenSide, kHiddenSide);
    const VitrailStats stats = panes.draw(GetParam(), order, picture);
    EXPECT_EQ(stats.fragmentsRequested, std::uint64_t{kPanes} * kHiddenSide * kHiddenSide);
    EXPECT_EQ(panes.shaded, std::uint64_t{4} * kHiddenSide * kHiddenSide) << "round " << round;
    EXPECT_TRUE(picture.pixels == first.pixels) << "round " << round;
  }
}

TEST_P(HiddenTest, TellingTheLeastAlphaChangesNoBit) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    SceneOptions options;
    options.draws = 60;
    options.primitives = 64;
    options.isShaded = seed % 2 == 0;
    options.depthOrder = seed % 4 < 2 ? VITRAIL_DEPTH_NEAREST_IS_ONE : VITRAIL_DEPTH_NEAREST_IS_ZERO;
    options.hasDiscards = seed % 3 == 0;
    options.hasOpaque = seed % 4 == 0;
    options.hasFilters = seed % 6 == 0;
    options.samples = seed % 7 == 0 ? 4 : 1;
    Scene scene = randomScene(random, options);
    if (seed % 6 != 1) keepBounded(scene);
    Raster raster(GetParam());
    const Drawn expected = draw(raster, scene);
    for (const auto& each : scene.draws) {
      if ((each->desc.shadeFlags & VITRAIL_CPU_SHADE_DISCARD) != 0) continue;
      each->desc.leastAlpha = 0.999F * std::min(each->material.color[3], each->material.other[3]);
    }
    const Drawn told = draw(raster, scene);
    EXPECT_TRUE(told.pixels == expected.pixels && told.depth == expected.depth) << "seed " << seed;
    EXPECT_EQ(told.stats.layersMax, expected.stats.layersMax);
    // What is hidden is not shaded, which would tell whether it is there.
    const auto fragments = static_cast<double>(expected.stats.fragmentsRequested);
    EXPECT_NEAR(static_cast<double>(told.stats.fragmentsRequested), fragments,
                options.hasDiscards ? 0.01 * fragments : 0);
    EXPECT_TRUE(draw(raster, scene, 0, false).pixels == expected.pixels) << "not counted, seed " << seed;
    EXPECT_TRUE(draw(raster, scene, 65536, false).pixels == expected.pixels) << "little memory, seed " << seed;
    std::reverse(scene.draws.begin(), scene.draws.end());
    const Drawn reversed = draw(raster, scene, 0, false);
    EXPECT_TRUE(options.hasOpaque || reversed.pixels == expected.pixels) << "reversed, seed " << seed;
  }
}

TEST_P(HiddenTest, FragmentsThatAreNotThereHideNothing) {
  constexpr std::uint32_t kPanes = 60;
  Panes panes(kPanes, 0.9F);
  for (std::size_t i = 0; i < 30; ++i) panes.panes[i].isHole = true;
  Picture picture(kHiddenSide, kHiddenSide);
  const VitrailStats stats = panes.draw(GetParam(), inOrder(kPanes), picture);
  EXPECT_EQ(stats.fragmentsRequested, std::uint64_t{30} * kHiddenSide * kHiddenSide);
  EXPECT_EQ(stats.layersMax, 30U);
  EXPECT_EQ(panes.shaded, std::uint64_t{34} * kHiddenSide * kHiddenSide);
  EXPECT_NEAR(picture.at(1, 1)[0], 0.5, 1e-4);
}

TEST_P(HiddenTest, NothingThatShowsIsLeftOut) {
  constexpr std::uint32_t kPanes = 48;
  Panes panes(kPanes, 0.02F);
  Picture picture(kHiddenSide, kHiddenSide, {0.0F, 1.0F, 0.0F, 1.0F});
  panes.draw(GetParam(), inOrder(kPanes), picture);
  EXPECT_EQ(panes.shaded, std::uint64_t{kPanes} * kHiddenSide * kHiddenSide);
  const double through = std::pow(0.98, kPanes);
  EXPECT_NEAR(picture.at(5, 5)[0], 0.5 * (1.0 - through), 1e-6);
  EXPECT_NEAR(picture.at(5, 5)[1], 0.5 * (1.0 - through) + through, 1e-6);
}

// Panes that cross in the middle of the picture, of one colour each: what is hidden is found while they come.
TEST_P(HiddenTest, FlatPanesAreAllCountedInWhateverOrderTheyCome) {
  constexpr std::uint32_t kPanes = 150;
  std::vector<std::vector<Position>> corners(kPanes);
  std::vector<VitrailCpuDraw> draws(kPanes);
  std::vector<std::array<double, 2>> ends(kPanes); // depths at the left and right border
  for (std::uint32_t i = 0; i < kPanes; ++i) {
    const float left = (static_cast<float>(i) + 0.5F) / kPanes;
    const float right =
        0.9731F * (static_cast<float>(i * 7 % kPanes) + 0.25F) / kPanes; // no two meet in a pixel's middle
    const auto at = [&](double x, double y) { return inPixels(kHiddenSide, kHiddenSide, x, y, x > 0 ? right : left); };
    corners[i] = {at(0, 0),           at(kHiddenSide, 0),           at(0, kHiddenSide),
                  at(kHiddenSide, 0), at(kHiddenSide, kHiddenSide), at(0, kHiddenSide)};
    ends[i] = {left, right};
  }
  for (std::uint32_t i = 0; i < kPanes; ++i) {
    draws[i] = drawOf(corners[i]);
    const float shade = static_cast<float>(i) / kPanes;
    const std::array<float, 4> color{shade, 1.0F - shade, 0.5F, i % 3 == 0 ? 0.6F : 0.2F};
    std::copy(color.begin(), color.end(), draws[i].color);
  }
  std::vector<std::size_t> order = inOrder(kPanes);
  Picture first(kHiddenSide, kHiddenSide);
  for (int round = 0; round < 4; ++round) {
    std::vector<VitrailCpuDraw> ordered;
    for (const std::size_t i : order) ordered.push_back(draws[i]);
    Raster raster(GetParam());
    Picture picture(kHiddenSide, kHiddenSide);
    VitrailStats stats{};
    ASSERT_EQ(raster.render(picture.frame(), ordered, &stats), VITRAIL_SUCCESS);
    EXPECT_EQ(stats.fragmentsRequested, std::uint64_t{kPanes} * kHiddenSide * kHiddenSide) << "round " << round;
    EXPECT_EQ(stats.layersMax, kPanes);
    if (round == 0) first = picture;
    EXPECT_TRUE(picture.pixels == first.pixels) << "round " << round;
    Picture uncounted(kHiddenSide, kHiddenSide);
    ASSERT_EQ(raster.render(uncounted.frame(), ordered), VITRAIL_SUCCESS);
    EXPECT_TRUE(uncounted.pixels == first.pixels) << "round " << round;
    if (round == 0) std::reverse(order.begin(), order.end());
    if (round > 0) std::shuffle(order.begin(), order.end(), Random(3 + static_cast<std::uint64_t>(round)).engine());
  }
  for (std::uint32_t x = 0; x < kHiddenSide; x += 3) {
    const double share = (x + 0.5) / kHiddenSide;
    std::vector<std::size_t> byDepth = inOrder(kPanes);
    const auto depthOf = [&](std::size_t i) { return ends[i][0] + share * (ends[i][1] - ends[i][0]); };
    std::ranges::sort(byDepth, {}, depthOf);
    double red = 0.0;
    double through = 1.0;
    for (const std::size_t i : byDepth) {
      red += through * double{draws[i].color[3]} * double{draws[i].color[0]};
      through *= 1.0 - double{draws[i].color[3]};
    }
    EXPECT_NEAR(first.at(x, 17)[0], red, 1.1e-4) << "column " << x;
  }
}

// Many triangles of which little is seen, in all depth orders, some of them clipped: what is behind all that shows of a
// tile is not even rasterised where nobody counts it.
TEST_P(HiddenTest, WhatIsNotCountedIsNotMissed) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    SceneOptions options;
    options.draws = 60;
    options.primitives = 64;
    options.isFlat = true;
    options.depthOrder = seed % 2 == 0 ? VITRAIL_DEPTH_NEAREST_IS_ONE : VITRAIL_DEPTH_NEAREST_IS_ZERO;
    options.isClipped = seed % 3 == 0;
    options.hasOpaque = seed % 4 == 0;
    options.hasOtherTopologies = seed % 5 == 0;
    Scene scene = randomScene(random, options);
    if (seed % 4 != 1) keepBounded(scene);
    for (const auto& each : scene.draws) each->desc.color[3] = 0.5F + 0.5F * each->desc.color[3];
    Raster raster(GetParam());
    const Drawn expected = draw(raster, scene);
    const Drawn uncounted = draw(raster, scene, 0, false);
    EXPECT_TRUE(uncounted.pixels == expected.pixels && uncounted.depth == expected.depth) << "seed " << seed;
    EXPECT_TRUE(draw(raster, scene, 65536, false).pixels == expected.pixels) << "little memory, seed " << seed;
    std::reverse(scene.draws.begin(), scene.draws.end());
    EXPECT_TRUE(draw(raster, scene, 0, false).pixels == expected.pixels) << "reversed, seed " << seed;
  }
}

// Surfaces in one plane, holes, filters and all blend modes, deep enough that some blocks wait and others do not.
TEST_P(HiddenTest, RandomFramesAreThoseOfAnyOrder) {
  std::uint64_t shown = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    SceneOptions options;
    options.draws = 70;
    options.primitives = 16;
    options.isShaded = seed % 2 == 0;
    options.hasFilters = seed % 3 == 0;
    options.hasDiscards = seed % 4 == 0;
    options.hasOpaque = seed % 5 == 0;
    Scene scene = randomScene(random, options);
    if (seed % 3 != 1) keepBounded(scene);
    for (const auto& each : scene.draws) {
      // Of opaque surfaces in one plane the last one shows.
      if (each->desc.surface == VITRAIL_CPU_OPAQUE || random.below(6) != 0) continue;
      for (std::size_t v = 0; v < each->vertices.size(); v += 4) each->vertices[v + 2] = 0.5F * each->vertices[v + 3];
    }
    Raster raster(GetParam());
    const Drawn expected = draw(raster, scene);
    shown = std::max<std::uint64_t>(shown, expected.stats.layersMax);
    EXPECT_TRUE(draw(raster, scene, 0, false).pixels == expected.pixels) << "not counted, seed " << seed;
    std::reverse(scene.draws.begin(), scene.draws.end());
    EXPECT_TRUE(draw(raster, scene).pixels == expected.pixels) << "reversed, seed " << seed;
    std::shuffle(scene.draws.begin(), scene.draws.end(), random.engine());
    EXPECT_TRUE(draw(raster, scene).pixels == expected.pixels) << "shuffled, seed " << seed;
  }
  EXPECT_GT(shown, 24U);
}

INSTANTIATE_TEST_SUITE_P(Instructions, HiddenTest, testing::ValuesIn(instructionsHere()),
                         [](const testing::TestParamInfo<VitrailCpuInstructions>& each) {
                           std::string name = nameOf(each.param);
                           std::erase(name, '-');
                           return name;
                         });

} // namespace
} // namespace vitrail::tests::raster
