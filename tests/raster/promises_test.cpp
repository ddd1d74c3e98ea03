// What cpu.h promises, where frames are unlike most: too little memory for a pixel of one depth, opaque surfaces at one
// depth that are not plain triangles, lanes in which nothing is, pixels that nobody draws on.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "host.h"

namespace vitrail::tests::raster {
namespace {

constexpr std::uint32_t kPromisedSide = 64;

// A triangle in the picture's corner.
std::vector<Position> corner() {
  const auto at = [](double x, double y) { return inPixels(kPromisedSide, kPromisedSide, x, y); };
  return {at(0, 0), at(20, 0), at(0, 20)};
}

void addColumn(std::vector<Position>& to, std::uint32_t x, float depth) {
  const auto at = [&](std::uint32_t right, double y) {
    return inPixels(kPromisedSide, kPromisedSide, x + right, y, depth);
  };
  to.insert(to.end(),
            {at(0, 0.0), at(1, 0.0), at(0, kPromisedSide), at(0, kPromisedSide), at(1, 0.0), at(1, kPromisedSide)});
}

// In one pixel of a block more fragments lie at one depth than fit into the budget, and stay together; in the next
// pixel they are at depths of their own, and are drawn window by window.
TEST(BudgetTest, FragmentsOfOneDepthBesideManyAreDrawnOnce) {
  constexpr std::uint32_t kCount = 1000;
  std::vector<Position> vertices;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    addColumn(vertices, 0, 0.5F);
    addColumn(vertices, 1, 0.1F + 0.8F * static_cast<float>(i * 7919 % kCount) / kCount);
  }
  VitrailCpuDraw draw = drawOf(vertices);
  draw.color[0] = 1.0F;
  draw.color[3] = 0.001F;
  Raster raster;
  Picture whole(kPromisedSide, kPromisedSide);
  VitrailStats stats{};
  ASSERT_EQ(raster.render(whole.frame(), {&draw, 1}, &stats), VITRAIL_SUCCESS);
  EXPECT_EQ(stats.layersMax, kCount);
  EXPECT_NEAR(whole.at(1, 1)[0], 1.0 - std::pow(1.0 - 0.001, kCount), 1e-4);
  for (const std::uint64_t budget : {65536U, 1U << 17U, 1U << 20U}) {
    Picture little(kPromisedSide, kPromisedSide);
    VitrailCpuFrame frame = little.frame();
    frame.memoryBudget = budget;
    VitrailStats again{};
    ASSERT_EQ(raster.render(frame, {&draw, 1}, &again), VITRAIL_SUCCESS);
    EXPECT_TRUE(little.pixels == whole.pixels) << budget;
    EXPECT_EQ(again.layersMax, kCount) << budget;
    EXPECT_EQ(again.fragmentsRequested, stats.fragmentsRequested) << budget;
  }
}

// Takes its time in each tile, so that all threads get some.
void shadeSlowly(void* /*user*/, VitrailCpuFragments* f) {
  if (f->x % 32 == 0 && f->y % 32 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  for (auto& channel : f->color) std::fill_n(channel, VITRAIL_CPU_LANES, 0.01F);
}

// Threads for which there is no room do not draw.
TEST(BudgetTest, HoldsForAnyNumberOfThreads) {
  constexpr std::uint32_t kWide = 8 * kPromisedSide;
  std::vector<Position> vertices;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const float depth = 0.01F + 0.02F * static_cast<float>(i);
    for (const auto& [x, y] : {std::pair{-1.0F, -1.0F}, {3.0F, -1.0F}, {-1.0F, 3.0F}})
      vertices.push_back({x, y, depth, 1.0F});
  }
  VitrailCpuDraw draw = drawOf(vertices);
  draw.shade = shadeSlowly;
  Raster one(VITRAIL_CPU_BEST, 1);
  Raster many(VITRAIL_CPU_BEST, 64);
  Picture whole(kWide, 32);
  VitrailCpuFrame frame = whole.frame();
  frame.samples = 8;
  ASSERT_EQ(one.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
  for (const std::uint64_t budget : {65536U, 100'000U}) {
    Picture little(kWide, 32);
    frame.color = little.pixels.data();
    frame.memoryBudget = budget;
    ASSERT_EQ(many.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
    EXPECT_TRUE(little.pixels == whole.pixels) << budget;
    EXPECT_LE(vitrailCpuFragmentBytes(many.get()), budget);
  }
}

// Draws, and every 4,096 triangles of one, count.
TEST(ManyDrawsTest, AreRefusedByTheirNumber) {
  const std::vector<Position> triangle = corner();
  VitrailCpuDraw draw = drawOf(triangle);
  draw.vertexCount = 3'000'000'000U; // nobody reads them
  const std::array<VitrailCpuDraw, 3> draws = {draw, draw, draw};
  Picture picture(8, 8);
  Raster raster;
  EXPECT_EQ(raster.render(picture.frame(), draws), VITRAIL_ERROR_UNSUPPORTED);
  const std::vector<std::string> lines = raster.takeLog();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("732423 parts"), std::string::npos) << lines[0];
  EXPECT_NE(lines[0].find("a frame takes 524287"), std::string::npos) << lines[0];
}

// The first draw is clipped, a line or a point: such are drawn in batches of their own.
TEST(OpaqueTest, OfOneDepthTheLastOneIsSeen) {
  const auto at = [](double x, double y) { return inPixels(kPromisedSide, kPromisedSide, x, y); };
  const std::vector<Position> quad = {at(0, 0),
                                      at(kPromisedSide, 0),
                                      at(0, kPromisedSide),
                                      at(0, kPromisedSide),
                                      at(kPromisedSide, 0),
                                      at(kPromisedSide, kPromisedSide)};
  const std::vector<Position> line = {at(0, 32.5), at(kPromisedSide, 32.5)};
  const std::vector<Position> point = {at(32, 32)};
  const std::array<float, 4> plane = {1.0F, 0.0F, 0.0F, 0.9F}; // cuts off a strip
  Raster raster;
  for (const std::uint32_t samples : {1U, 4U}) {
    for (int kind = 0; kind < 3; ++kind) {
      for (const bool isLast : {false, true}) {
        VitrailCpuDraw special = drawOf(kind == 0 ? quad : kind == 1 ? line : point);
        if (kind == 0) {
          special.clipPlanes = plane.data();
          special.clipPlaneCount = 1;
        }
        if (kind == 1) special.topology = VITRAIL_CPU_LINES;
        if (kind == 2) special.topology = VITRAIL_CPU_POINTS;
        special.pointSize = 20.0F;
        special.surface = VITRAIL_CPU_OPAQUE;
        special.color[0] = 1.0F;
        VitrailCpuDraw plain = drawOf(quad);
        plain.surface = VITRAIL_CPU_OPAQUE;
        plain.color[2] = 1.0F;
        const std::array<VitrailCpuDraw, 2> draws = isLast ? std::array{plain, special} : std::array{special, plain};
        Picture picture(kPromisedSide, kPromisedSide);
        VitrailCpuFrame frame = picture.frame();
        frame.samples = samples;
        ASSERT_EQ(raster.render(frame, draws), VITRAIL_SUCCESS);
        std::size_t red = 0;
        for (std::size_t i = 0; i < picture.pixels.size(); i += 4) red += picture.pixels[i] > 0.0F ? 1 : 0;
        SCOPED_TRACE(std::to_string(samples) + " samples, kind " + std::to_string(kind));
        if (isLast) {
          EXPECT_GT(red, 50U);
        } else {
          EXPECT_EQ(red, 0U);
        }
      }
    }
  }
}

// Within a draw, too: the small square lies in one tile, the large one in many.
TEST(OpaqueTest, OfOneDrawAndDepthTheLastTriangleIsSeen) {
  const auto addSquare = [](std::vector<Position>& to, double low, double high) {
    const auto at = [](double x, double y) { return inPixels(kPromisedSide, kPromisedSide, x, y); };
    to.insert(to.end(), {at(low, low), at(high, low), at(low, high), at(low, high), at(high, low), at(high, high)});
  };
  Raster raster;
  for (const std::uint32_t samples : {1U, 4U}) {
    for (const bool isSmallLast : {false, true}) {
      std::vector<Position> squares;
      if (!isSmallLast) addSquare(squares, 4, 12);
      addSquare(squares, 0, kPromisedSide);
      if (isSmallLast) addSquare(squares, 4, 12);
      VitrailCpuDraw draw = drawOf(squares);
      draw.surface = VITRAIL_CPU_OPAQUE;
      draw.shade = [](void* /*user*/, VitrailCpuFragments* f) {
        for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) f->color[0][i] = static_cast<float>(f->triangle[i] / 2);
      };
      Picture picture(kPromisedSide, kPromisedSide);
      VitrailCpuFrame frame = picture.frame();
      frame.samples = samples;
      ASSERT_EQ(raster.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
      EXPECT_EQ(picture.at(8, 8)[0], 1.0F) << samples << " samples, " << isSmallLast;
    }
  }
}

struct Watched {
  std::uint32_t triangles;
  std::uint64_t calls = 0;
  std::uint64_t wrongTriangles = 0;
  std::uint64_t wrongNumbers = 0;
};

void shadeWatched(void* user, VitrailCpuFragments* f) {
  Watched& watched = *static_cast<Watched*>(user);
  ++watched.calls;
  for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
    if (f->triangle[i] >= watched.triangles) ++watched.wrongTriangles;
    if (!std::isfinite(f->depth[i]) || !std::isfinite(f->second[i]) || !std::isfinite(f->third[i]))
      ++watched.wrongNumbers;
    for (auto& channel : f->color) channel[i] = 0.5F;
    f->color[3][i] = 0.01F;
  }
}

// A function may look up what all lanes name, whatever draws the block's rows held before.
TEST(ShadeTest, LanesWithoutAFragmentNameTrianglesOfTheDraw) {
  std::array<std::vector<Position>, 3> vertices;
  const auto add = [&](std::size_t draw, double x, double y, double size, float depth) {
    for (const auto& [right, down] : {std::pair{0.0, 0.0}, {size, 0.0}, {0.0, size}}) {
      vertices.at(draw).push_back(inPixels(kPromisedSide, kPromisedSide, x + right, y + down, depth));
    }
  };
  for (int i = 0; i < 60; ++i) add(0, 2, 0, 4, 0.1F + 0.001F * static_cast<float>(i));
  for (int i = 0; i < 3940; ++i) add(1, -200, -200, 4, 0.5F);
  for (int i = 0; i < 60; ++i) add(1, 0, 0, 2, 0.2F + 0.001F * static_cast<float>(i));
  for (int i = 0; i < 200; ++i) add(2, 2, 0, 4, 0.5F + 0.001F * static_cast<float>(i));
  std::array<Watched, 3> watched{};
  std::array<VitrailCpuDraw, 3> draws{};
  for (std::size_t i = 0; i < draws.size(); ++i) {
    watched[i].triangles = static_cast<std::uint32_t>(vertices[i].size() / 3);
    draws[i] = drawOf(vertices[i]);
    draws[i].shade = shadeWatched;
    draws[i].shadeUser = &watched[i];
    draws[i].brightest = 1.0F;
  }
  Raster raster(VITRAIL_CPU_BEST, 1); // with all of the budget
  for (const std::uint64_t budget : {0U, 65536U}) {
    Picture picture(kPromisedSide, kPromisedSide);
    VitrailCpuFrame frame = picture.frame();
    frame.memoryBudget = budget;
    ASSERT_EQ(raster.render(frame, draws), VITRAIL_SUCCESS);
    for (const Watched& each : watched) {
      EXPECT_GT(each.calls, 0U);
      EXPECT_EQ(each.wrongTriangles, 0U) << budget;
      EXPECT_EQ(each.wrongNumbers, 0U) << budget;
    }
  }
}

void shadeNumbers(void* user, VitrailCpuFragments* f) {
  std::uint64_t& wrong = *static_cast<std::uint64_t*>(user);
  for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
    for (const auto& values : {f->depth, f->second, f->third, f->secondDx, f->secondDy, f->thirdDx, f->thirdDy})
      wrong += std::isfinite(values[i]) ? 0 : 1;
    for (auto& channel : f->color) channel[i] = 0.5F;
  }
}

VitrailCpuDraw drawOfNumbers(const std::vector<Position>& corners, VitrailCpuSurface surface, std::uint64_t& wrong) {
  VitrailCpuDraw draw = drawOf(corners);
  draw.surface = surface;
  draw.shade = shadeNumbers;
  draw.shadeUser = &wrong;
  draw.shadeFlags = VITRAIL_CPU_SHADE_DERIVATIVES | VITRAIL_CPU_SHADE_DISCARD;
  return draw;
}

// The smallest w that can be drawn and the largest, in one triangle, whose corners may lie in the middles of pixels.
TEST(ShadeTest, WeightsAreNumbersWhateverTheCornersAre) {
  Random random(70);
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions);
    for (const std::uint32_t samples : {1U, 8U}) {
      for (int round = 0; round < 60; ++round) {
        std::vector<Position> corners;
        for (int i = 0; i < 60; ++i) {
          const double size = round % 2 == 0 ? 1.0 : 20.0;
          const auto place = [&] { return i % 4 == 0 ? random.whole(0, 31) + 0.5 : 16.0 + random.real(-size, size); };
          const auto w = static_cast<float>(std::pow(10.0, random.below(2) == 0 ? -37.9 : random.real(-37.9, 30.0)));
          corners.push_back(inPixels(32, 32, place(), place(), random.single(0.0, 1.0), w));
        }
        for (const VitrailCpuSurface surface : {VITRAIL_CPU_TRANSPARENT, VITRAIL_CPU_OPAQUE}) {
          std::uint64_t wrong = 0;
          const VitrailCpuDraw draw = drawOfNumbers(corners, surface, wrong);
          Picture picture(32, 32);
          VitrailCpuFrame frame = picture.frame();
          frame.samples = samples;
          ASSERT_EQ(raster.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
          EXPECT_EQ(wrong, 0U) << "round " << round << ", " << samples << " samples, surface " << surface;
        }
      }
    }
  }
}

// Beyond the horizon of a triangle that ends in the block.
TEST(ShadeTest, LanesBesideAnOpaqueTriangleAreNumbers) {
  const std::vector<Position> corners = {inPixels(16, 16, 0.5, 0.5, 0.5F, 1.0F), inPixels(16, 16, 1.5, 0.5, 0.5F, 2.0F),
                                         inPixels(16, 16, 0.5, 4.5, 0.5F, 1.0F)};
  std::uint64_t wrong = 0;
  const VitrailCpuDraw draw = drawOfNumbers(corners, VITRAIL_CPU_OPAQUE, wrong);
  Picture picture(16, 16);
  Raster raster;
  ASSERT_EQ(raster.render(picture.frame(), {&draw, 1}), VITRAIL_SUCCESS);
  EXPECT_EQ(wrong, 0U);
}

// Where the w of the corners differ so much that one over the smallest is nothing beside one over the largest.
TEST(ShadeTest, TheFarthestCornerHasItsOwnWeight) {
  const std::vector<Position> corners = {inPixels(16, 16, 8.5, 0.5, 0.5F, 1e-6F),
                                         inPixels(16, 16, 0.5, 8.5, 0.5F, 1e6F),
                                         inPixels(16, 16, 15.5, 15.5, 0.5F, 1e-6F)};
  std::array<float, 2> second{-1.0F, -1.0F};
  VitrailCpuDraw draw = drawOf(corners);
  draw.shade = [](void* user, VitrailCpuFragments* f) {
    for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
      for (auto& channel : f->color) channel[i] = 0.5F;
      const bool isFar = f->x + i % 4 == 0 && f->y + i / 4 == 8;
      if (isFar && (f->mask >> i & 1U) != 0) static_cast<std::array<float, 2>*>(user)->front() = f->second[i];
      if (!isFar && (f->mask >> i & 1U) != 0)
        static_cast<std::array<float, 2>*>(user)->back() =
            std::max(f->second[i], static_cast<std::array<float, 2>*>(user)->back());
    }
  };
  draw.shadeUser = &second;
  Picture picture(16, 16);
  Raster raster;
  ASSERT_EQ(raster.render(picture.frame(), {&draw, 1}), VITRAIL_SUCCESS);
  EXPECT_NEAR(second[0], 1.0F, 1e-6F);
  EXPECT_LE(second[1], 1e-9F);
}

// One triangle, and random colours behind it.
TEST(SamplesTest, PixelsWithoutAFragmentStayAsTheyAre) {
  const std::vector<Position> triangle = {inPixels(kPromisedSide, kPromisedSide, 1.5, 1.5),
                                          inPixels(kPromisedSide, kPromisedSide, 30.5, 2.5),
                                          inPixels(kPromisedSide, kPromisedSide, 2.5, 40.5)};
  VitrailCpuDraw draw = drawOf(triangle);
  draw.color[0] = 1.0F;
  draw.color[3] = 1.0F;
  Raster raster;
  for (const std::uint32_t samples : {2U, 4U, 8U}) {
    Random random(samples);
    Picture picture(kPromisedSide, kPromisedSide);
    for (float& value : picture.pixels) value = random.single(0.0, 1.0);
    const std::vector<float> before = picture.pixels;
    VitrailCpuFrame frame = picture.frame();
    frame.samples = samples;
    ASSERT_EQ(raster.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
    std::size_t changed = 0;
    for (std::uint32_t y = 0; y < kPromisedSide; ++y) {
      for (std::uint32_t x = 0; x < kPromisedSide; ++x) {
        const std::size_t at = (std::size_t{y} * kPromisedSide + x) * 4;
        const bool isSame = std::equal(&before[at], &before[at] + 4, &picture.pixels[at]);
        changed += isSame ? 0 : 1;
        const bool isBeside = x < 1 || y < 1 || x > 31 || y > 41 || x + y > 48;
        EXPECT_TRUE(isSame || !isBeside) << x << ' ' << y << ' ' << samples;
      }
    }
    EXPECT_GT(changed, 400U);
  }
}

TEST(EightBitTest, AlphaIs255Everywhere) {
  const std::vector<Position> triangle = corner();
  VitrailCpuDraw draw = drawOf(triangle);
  draw.color[3] = 0.5F;
  std::vector<std::uint8_t> bytes(std::size_t{kPromisedSide} * kPromisedSide * 4, 7);
  VitrailCpuFrame frame{};
  frame.width = frame.height = kPromisedSide;
  frame.colorFormat = VITRAIL_CPU_RGBA8_SRGB;
  frame.color = bytes.data();
  Raster raster;
  ASSERT_EQ(raster.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
  for (std::size_t i = 0; i < bytes.size(); i += 4) ASSERT_EQ(bytes[i + 3], 255) << i / 4;
  EXPECT_EQ(bytes[bytes.size() - 4], 7);
}

void shadeFilter(void* /*user*/, VitrailCpuFragments* f) {
  for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
    for (auto& channel : f->color) channel[i] = 0.0F;
    f->color[3][i] = 0.5F;
    for (auto& channel : f->filter) channel[i] = 40'000.0F;
  }
}

// What was left out behind too little light is not made bright again.
TEST(FilterTest, LetsAllThroughAtMost) {
  const std::vector<Position> triangle = corner();
  VitrailCpuDraw draw = drawOf(triangle);
  draw.blend = VITRAIL_BLEND_PREMULTIPLIED;
  draw.shade = shadeFilter;
  draw.shadeFlags = VITRAIL_CPU_SHADE_FILTER;
  Picture picture(kPromisedSide, kPromisedSide, {1.0F, 1.0F, 1.0F, 1.0F});
  Raster raster;
  ASSERT_EQ(raster.render(picture.frame(), {&draw, 1}), VITRAIL_SUCCESS);
  EXPECT_EQ(picture.at(2, 2)[0], 0.5F);
}

// ---- Light that is no number

// Filters whose product is more than a float holds.
TEST(FilterTest, ProductsBeyondAllNumbersAreNumbers) {
  std::vector<Position> middle;
  std::vector<Position> back;
  for (int i = 0; i < 12; ++i) {
    for (const Position& p : corner()) middle.push_back({p[0], p[1], 0.2F + 0.01F * static_cast<float>(i), 1.0F});
  }
  for (const Position& p : corner()) back.push_back({p[0], p[1], 0.9F, 1.0F});
  std::array<VitrailCpuDraw, 2> draws{drawOf(middle), drawOf(back)};
  draws[0].blend = draws[1].blend = VITRAIL_BLEND_MULTIPLY;
  std::fill_n(draws[0].color, 3, 65504.0F);
  draws[1].color[2] = 1.0F;
  draws[0].color[3] = draws[1].color[3] = 1.0F;
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions);
    for (const std::uint32_t samples : {1U, 4U}) {
      // Over darkness and light; then darkness by a filter behind them; then black that hides.
      for (int kind = 0; kind < 3; ++kind) {
        draws[1].blend = kind == 2 ? VITRAIL_BLEND_OVER : VITRAIL_BLEND_MULTIPLY;
        Picture picture(kPromisedSide, kPromisedSide, {0.0F, 1.0F, 1e-3F, 1.0F});
        VitrailCpuFrame frame = picture.frame();
        frame.samples = samples;
        ASSERT_EQ(raster.render(frame, std::span(draws).first(kind == 0 ? 1 : 2)), VITRAIL_SUCCESS);
        const float* pixel = picture.at(2, 2);
        EXPECT_EQ(pixel[0], 0.0F) << kind;
        EXPECT_TRUE(kind == 0 ? pixel[1] > 1e38F : pixel[1] == 0.0F) << kind << ": " << pixel[1];
        EXPECT_GT(pixel[2], 1e35F) << kind;
        EXPECT_EQ(pixel[3], 1.0F) << kind;
      }
    }
  }
}

TEST(BehindTest, WhatIsHiddenMayBeAnything) {
  const std::vector<Position> triangle = corner();
  VitrailCpuDraw draw = drawOf(triangle);
  draw.color[1] = 0.5F;
  draw.color[3] = 1.0F;
  Raster raster;
  for (const float behind : {INFINITY, NAN}) {
    for (const std::uint32_t samples : {1U, 2U}) {
      Picture picture(kPromisedSide, kPromisedSide, {behind, behind, behind, behind});
      VitrailCpuFrame frame = picture.frame();
      frame.samples = samples;
      ASSERT_EQ(raster.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
      const float* pixel = picture.at(2, 2);
      EXPECT_TRUE(pixel[0] == 0.0F && pixel[1] == 0.5F && pixel[3] == 1.0F) << behind << ", " << samples << " samples";
    }
  }
}

void shadeBright(void* /*user*/, VitrailCpuFragments* f) {
  for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
    for (auto& channel : f->color) channel[i] = 50'000.0F;
    f->color[3][i] = 1.0F;
  }
}

TEST(BrightestTest, BoundsWhatShadeFunctionsGive) {
  const std::vector<Position> triangle = corner();
  Raster raster;
  for (const VitrailCpuSurface surface : {VITRAIL_CPU_TRANSPARENT, VITRAIL_CPU_OPAQUE}) {
    VitrailCpuDraw draw = drawOf(triangle);
    draw.shade = shadeBright;
    draw.brightest = 2.0F;
    draw.surface = surface;
    Picture picture(kPromisedSide, kPromisedSide);
    ASSERT_EQ(raster.render(picture.frame(), {&draw, 1}), VITRAIL_SUCCESS);
    EXPECT_EQ(picture.at(2, 2)[0], 2.0F) << surface;
  }
}

} // namespace
} // namespace vitrail::tests::raster
