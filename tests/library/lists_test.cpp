// The library list by list, at one sample: every list length against the reference resolve in
// double precision, in every node format, blend mode and way to resolve; equal depths, hostile values, statistics.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "../thorough.h"
#include "expected.h"

namespace vitrail::tests {
namespace {

class ListsTest : public BackendTest {};
VITRAIL_ON_EVERY_BACKEND(ListsTest);

// What single-precision blending and a device's pow() may add up to. A fragment at rank n of a list of 1/255 layers
// weighs 1/255 * (254/255)^n: a wrong one is seen down to rank 1,500.
constexpr double kBlendTolerance = 1e-5;

// 0 to 67: every remainder of the sorting blocks, twice and more; and some beyond.
std::vector<std::uint32_t> manyLengths(std::initializer_list<std::uint32_t> longer) {
  std::vector<std::uint32_t> lengths(68);
  std::iota(lengths.begin(), lengths.end(), 0U);
  lengths.insert(lengths.end(), longer);
  return lengths;
}

constexpr std::array kListBuilds{VITRAIL_LIST_BUILD_FRAGMENT, VITRAIL_LIST_BUILD_COMPUTE};

void expectLikeReference(const PointResult& result, const Expected& expected, double tolerance = kBlendTolerance) {
  EXPECT_LT(largestError(result.pixels, expected.pixels), tolerance);
  EXPECT_EQ(result.stats.complete, 1U);
  EXPECT_EQ(result.stats.fragmentsRequested, expected.fragments);
  EXPECT_EQ(result.stats.fragmentsStored, expected.fragments);
  EXPECT_EQ(result.stats.fragmentsMissing, 0U);
  EXPECT_EQ(result.stats.layersMax, expected.layersMax);
  EXPECT_EQ(result.stats.coveredPixels, expected.coveredPixels);
  EXPECT_EQ(result.stats.approximatePixels, 0U);
  EXPECT_EQ(result.stats.cutPixels, 0U);
}

TEST_P(ListsTest, EveryListLengthMatchesTheReferenceInEveryOrder) {
  std::size_t number = 0;
  for (const Way& way : everyWay(features(), 1)) {
    for (const VitrailDepthOrder depthOrder : {VITRAIL_DEPTH_NEAREST_IS_ZERO, VITRAIL_DEPTH_NEAREST_IS_ONE}) {
      // Each has kernels of its own: if not thorough, every way has one of them, in turns.
      const std::size_t place = number++;
      if (place / 2 % 2 != place % 2 && !isThorough()) continue;
      SCOPED_TRACE(way.name);
      HostDesc desc;
      desc.width = 16;
      desc.height = 8;
      desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
      desc.depthOrder = depthOrder;
      apply(way, desc);
      const std::vector<Point> points =
          randomLists(desc, manyLengths({127, 128, 129, 255, 256, 700, 1023, 1025, 5000, features().uncutLayers}), 5);
      desc.capacity = static_cast<std::uint32_t>(points.size());
      const auto host = makeHost(desc);
      const PointResult forward = host->draw(points);
      expectLikeReference(forward, expectedFrame(desc, points));
      for (const Order order : {Order::Reversed, Order::Shuffled}) {
        EXPECT_TRUE(host->draw(ordered(points, order)).pixels == forward.pixels) << "order changes the picture";
      }
    }
  }
}

// On a device that runs many fragments at once a node that was pushed later may lie before an earlier one, and the list
// that has nearly all nodes of the pool meets every place of it.
TEST_P(ListsTest, WhereNodesLieInThePoolDoesNotMatter) {
  for (const Way& way : everyWay(features(), 1)) {
    SCOPED_TRACE(way.name);
    HostDesc desc;
    desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
    desc.overflow = VITRAIL_OVERFLOW_SKIP;
    desc.guarded = true;
    apply(way, desc);
    for (const std::vector<std::uint32_t>& lengths :
         {std::vector<std::uint32_t>{0, 1, 2, 5, 16, 17, 31, 32, 33, 100, 128, 129, 400}, {3000}, {100}, {40}}) {
      const std::vector<Point> points = randomLists(desc, lengths, 8);
      desc.capacity = static_cast<std::uint32_t>(points.size());
      const auto host = makeHost(desc);
      const PointResult result = host->drawScattered(points);
      expectLikeReference(result, expectedFrame(desc, points));
      EXPECT_TRUE(host->draw(points).pixels == result.pixels);
      EXPECT_TRUE(host->guardsUntouched());
    }
  }
}

// Colours of `hdr` reach 8 here, and what lists add up to in it more: errors are relative.
TEST_P(ListsTest, EveryFormatAndBlendModeMatchesTheReferenceInEveryOrder) {
  for (const VitrailNodeFormat format : nodeFormats(1)) {
    for (const Way& way : everyWay(features(), 1)) {
      if (way.resolve == VITRAIL_RESOLVE_FRAGMENT && !features().dualSourceBlending) continue;
      SCOPED_TRACE(way.name + ", format " + std::to_string(format));
      HostDesc desc;
      desc.width = 16;
      desc.height = 8;
      desc.behind = {0.25F, 0.5F, 1.0F, 0.75F};
      desc.nodes = format;
      desc.depthOrder = way.stencilMark ? VITRAIL_DEPTH_NEAREST_IS_ONE : VITRAIL_DEPTH_NEAREST_IS_ZERO;
      desc.specialized = true;
      apply(way, desc);
      if (desc.listBuild == VITRAIL_LIST_BUILD_COMPUTE) desc.shader = ShaderKind::ForCpu; // with each list build
      if (desc.resolve == VITRAIL_RESOLVE_FRAGMENT && !way.stencilMark) desc.shader = ShaderKind::ForCpu;
      PointVariety variety;
      variety.blendModes = true;
      variety.brightest = format == VITRAIL_NODE_HDR ? 8.0F : 1.0F;
      const std::vector<Point> points = randomLists(desc, manyLengths({100, 300, 1200}), 6, variety);
      desc.capacity = static_cast<std::uint32_t>(points.size());
      const auto host = makeHost(desc);
      const PointResult forward = host->draw(ordered(points, Order::Shuffled));
      expectLikeReference(forward, expectedFrame(desc, points), 2e-5);
      EXPECT_TRUE(host->draw(ordered(points, Order::Reversed)).pixels == forward.pixels);
    }
  }
}

// Every way computes the same picture, up to what fixed-function blending rounds.
TEST_P(ListsTest, BothResolvesAgree) {
  std::vector<std::vector<FloatColor>> pictures;
  HostDesc desc;
  desc.behind = {0.2F, 0.4F, 0.6F, 1.0F};
  const std::vector<Point> points = randomLists(desc, {0, 1, 2, 5, 16, 17, 31, 32, 33, 80, 400}, 8);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  for (const Way& way : everyWay(features(), 1)) {
    apply(way, desc);
    pictures.push_back(draw(desc, points).pixels);
  }
  for (const auto& picture : pictures) {
    for (std::size_t i = 0; i < picture.size(); ++i) {
      for (unsigned c = 0; c < 4; ++c) EXPECT_NEAR(picture[i][c], pictures[0][i][c], 1e-6F) << "pixel " << i;
    }
  }
}

// Without dual-source blending a filter's colour is blended as grey, and said to be.
TEST_P(ListsTest, WithoutDualSourceBlendingColouredFiltersAreCounted) {
  HostDesc desc;
  desc.resolve = VITRAIL_RESOLVE_FRAGMENT;
  desc.dualSourceBlending = false;
  desc.behind = {0.5F, 0.5F, 0.5F, 1.0F};
  const std::vector<Point> points = {{0, 0, 0.5F, {1.0F, 0.0F, 0.0F, 1.0F}, VITRAIL_BLEND_MULTIPLY},
                                     {2, 0, 0.5F, {1.0F, 0.0F, 0.0F, 0.2F}}};
  desc.capacity = 2;
  const PointResult result = draw(desc, points);
  EXPECT_EQ(result.stats.approximatePixels, 1U);
  EXPECT_EQ(result.stats.complete, 0U);
  for (unsigned c = 0; c < 3; ++c) EXPECT_NEAR(result.pixels[0][c], 0.5F / 3.0F, 1e-6F); // the mean of 1, 0, 0
  const Expected expected = expectedFrame(desc, points);
  for (unsigned c = 0; c < 3; ++c) EXPECT_NEAR(result.pixels[2][c], expected.pixels[2][c], 1e-6);
}

// Filters brighter than 1 multiply light beyond what a float holds. What is dark behind them is dark.
TEST_P(ListsTest, LightBeyondAllFloatsStaysANumber) {
  HostDesc desc;
  desc.resolve = VITRAIL_RESOLVE_COMPUTE;
  desc.nodes = VITRAIL_NODE_HDR;
  desc.behind = {0.25F, 0.25F, 0.25F, 1.0F};
  std::vector<Point> points;
  for (const std::uint32_t count : {3U, 12U, 40U}) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const float depth = 0.1F + 0.01F * static_cast<float>(i);
      points.push_back({count % 8, 0, depth, {65504.0F, 65504.0F, 65504.0F, 1.0F}, VITRAIL_BLEND_MULTIPLY});
    }
    points.push_back({count % 8, 0, 0.9F, {0.0F, 0.0F, 0.0F, 1.0F}, VITRAIL_BLEND_MULTIPLY});
  }
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const PointResult result = draw(desc, points);
  EXPECT_EQ(result.stats.complete, 1U);
  for (const std::size_t x : {3, 4, 0}) {
    for (unsigned c = 0; c < 3; ++c) EXPECT_EQ(result.pixels[x][c], 0.0F) << x;
  }
}

// Of two pixels with 30 fragments each has at least 10 of 40 nodes. Whichever compute kernel blends the frame counts
// both, a fragment resolve neither.
TEST_P(ListsTest, DeepPixelsOfAFrameThatOverflowsAreCounted) {
  for (const bool compute : {true, false}) {
    HostDesc desc;
    desc.resolve = compute ? VITRAIL_RESOLVE_COMPUTE : VITRAIL_RESOLVE_FRAGMENT;
    desc.maxLayers = 4;
    desc.capacity = 40;
    const std::vector<Point> points = randomLists(desc, {30, 0, 30}, 12);
    const VitrailStats stats = draw(desc, points).stats;
    EXPECT_EQ(stats.fragmentsMissing, 20U);
    EXPECT_EQ(stats.approximatePixels, compute ? 2U : 0U);
    EXPECT_EQ(stats.coveredPixels, compute ? 2U : 0U);
    EXPECT_GE(stats.layersMax, compute ? 20U : 0U);
    EXPECT_LE(stats.layersMax, compute ? 30U : 0U);
  }
}

TEST_P(ListsTest, DeepPixelsAreCountedOnce) {
  for (const Way& way : everyWay(features(), 1)) {
    SCOPED_TRACE(way.name);
    HostDesc desc;
    desc.maxLayers = 20;
    apply(way, desc);
    const std::vector<Point> points = randomLists(desc, {0, 1, 16, 17, 20, 21, 32, 33, 64, 65, 128, 129}, 17);
    desc.capacity = static_cast<std::uint32_t>(points.size());
    const PointResult result = draw(desc, points);
    EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), kSumTolerance);
    EXPECT_EQ(result.stats.approximatePixels, 7U);
    EXPECT_EQ(result.stats.coveredPixels, 11U);
    EXPECT_EQ(result.stats.layersMax, 129U);
  }
}

// The shortest lists that take most room in the arrays of lists that are left to groups: both ends of it meet.
TEST_P(ListsTest, DeepPixelsFillTheirArrays) {
  for (const std::uint32_t other : {33U, 65U}) {
    HostDesc desc;
    desc.width = 16;
    desc.height = 8;
    desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
    std::vector<std::uint32_t> lengths(128, 65);
    for (std::size_t i = 0; i < lengths.size(); i += 2) lengths[i] = other;
    const std::vector<Point> points = randomLists(desc, lengths, 19);
    desc.capacity = static_cast<std::uint32_t>(points.size());
    desc.guarded = true;
    const auto host = makeHost(desc);
    expectLikeReference(host->draw(points), expectedFrame(desc, points));
    EXPECT_TRUE(host->guardsUntouched());
  }
}

TEST_P(ListsTest, TheNearestFragmentIsOnTop) {
  HostDesc desc;
  desc.capacity = 2;
  const std::vector<Point> points = {{3, 5, 0.25F, {1.0F, 0.0F, 0.0F, 1.0F}}, {3, 5, 0.75F, {0.0F, 1.0F, 0.0F, 1.0F}}};
  const std::array<float, 4> red = {1.0F, 0.0F, 0.0F, 1.0F};
  const std::array<float, 4> green = {0.0F, 1.0F, 0.0F, 1.0F};
  const std::size_t pixel = 5 * desc.width + 3;
  EXPECT_EQ(draw(desc, points).pixels[pixel], red);
  desc.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
  EXPECT_EQ(draw(desc, points).pixels[pixel], green);
}

TEST_P(ListsTest, PixelsWithoutFragmentsKeepTheirBits) {
  HostDesc desc;
  desc.capacity = 1;
  desc.behind = {0.1F, 123.456F, 1e-30F, 0.3F};
  const PointResult result = draw(desc, {});
  for (const auto& pixel : result.pixels) EXPECT_EQ(pixel, desc.behind);
  EXPECT_EQ(result.stats.complete, 1U);
  EXPECT_EQ(result.stats.coveredPixels, 0U);
  EXPECT_EQ(result.stats.layersMax, 0U);
}

TEST_P(ListsTest, ATransparentBackgroundEndsPremultiplied) {
  HostDesc desc;
  desc.capacity = 1;
  desc.behind = {0.0F, 0.0F, 0.0F, 0.0F};
  const Point point = {0, 0, 0.5F, {1.0F, 1.0F, 0.0F, 51.0F / 255.0F}};
  const auto pixel = draw(desc, std::span(&point, 1)).pixels[0];
  EXPECT_NEAR(pixel[0], 0.2F, 1e-6F);
  EXPECT_NEAR(pixel[1], 0.2F, 1e-6F);
  EXPECT_NEAR(pixel[2], 0.0F, 1e-6F);
  EXPECT_NEAR(pixel[3], 0.2F, 1e-6F);
}

// Thousands of equal fragments between others: sorting must neither lose nor repeat one.
TEST_P(ListsTest, ManyEqualFragmentsAreAllBlendedOnce) {
  HostDesc desc;
  desc.width = 4;
  desc.height = 1;
  desc.behind = {1.0F, 1.0F, 1.0F, 1.0F};
  std::vector<Point> points;
  const std::array<std::uint32_t, 4> counts = {15, 16, 33, 1000};
  for (std::uint32_t x = 0; x < desc.width; ++x) {
    const float alpha = (x == 3 ? 1.0F : 9.0F) / 255.0F;
    for (std::uint32_t i = 0; i < 7; ++i) points.push_back({x, 0, 0.1F, {1.0F, 0.0F, 0.0F, 20.0F / 255.0F}});
    for (std::uint32_t i = 0; i < counts[x]; ++i) points.push_back({x, 0, 0.5F, {0.0F, 0.0F, 1.0F, alpha}});
    for (std::uint32_t i = 0; i < 40; ++i) points.push_back({x, 0, 0.9F, {0.0F, 1.0F, 0.0F, 20.0F / 255.0F}});
  }
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const auto host = makeHost(desc);
  const PointResult result = host->draw(ordered(points, Order::Shuffled));
  EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), 1e-4);
  EXPECT_TRUE(host->draw(points).pixels == result.pixels);
}

TEST_P(ListsTest, EqualDepthsAreOrderedByTheNodeAndNotByArrival) {
  for (const VitrailNodeFormat format : nodeFormats(1)) {
    for (const Way& way : everyWay(features(), 1)) {
      if (format != VITRAIL_NODE_STANDARD && way.resolve == VITRAIL_RESOLVE_FRAGMENT) continue; // keys are keys
      SCOPED_TRACE(way.name + ", format " + std::to_string(format));
      HostDesc desc;
      desc.nodes = format;
      apply(way, desc);
      PointVariety variety;
      variety.blendModes = way.resolve == VITRAIL_RESOLVE_COMPUTE;
      std::vector<Point> points = randomLists(desc, {2, 3, 9, 16, 17, 40, 90}, 4, variety);
      for (Point& point : points) point.depth = 0.5F;
      points.push_back(points.back()); // two that are the same in everything
      desc.capacity = static_cast<std::uint32_t>(points.size());
      const auto host = makeHost(desc);
      const PointResult forward = host->draw(points);
      EXPECT_LT(largestError(forward.pixels, expectedFrame(desc, points).pixels), kBlendTolerance);
      EXPECT_TRUE(host->draw(ordered(points, Order::Reversed)).pixels == forward.pixels);
      EXPECT_TRUE(host->draw(ordered(points, Order::Shuffled)).pixels == forward.pixels);
    }
  }
}

// Mesa's CPU driver ends a shader's loops after 65,535 turns in total: a list that it cuts short must be reported, not
// blended silently wrong. On a GPU the same list is exact.
TEST_P(ListsTest, AListThatTheDriverCutsIsReported) {
  HostDesc desc;
  const std::vector<Point> points = randomLists(desc, {300000U, 3U}, 9);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const PointResult result = draw(desc, points);
  EXPECT_EQ(result.stats.fragmentsMissing, 0U);
  EXPECT_EQ(result.stats.complete == 1U, result.stats.cutPixels == 0U);
  if (result.stats.complete == 1U) {
    EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), kBlendTolerance);
  } else {
    EXPECT_EQ(result.stats.cutPixels, 1U);
  }
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A colour that rounds to black: on the way, to something else.
constexpr float kFaint = 1.4e-4F;

void expectHostileColoursApart(Backend& backend, VitrailNodeFormat format, VitrailListBuild listBuild) {
  const float brightest = format == VITRAIL_NODE_HDR ? 65504.0F : 1.0F;
  HostDesc desc;
  desc.nodes = format;
  desc.listBuild = listBuild;
  desc.behind = {0.5F, 0.5F, 0.5F, 1.0F};
  const std::vector<Point> points = {
      {0, 0, 0.5F, {kNan, 0.5F, 0.5F, 1.0F}},
      {1, 0, 0.5F, {0.5F, 0.5F, 0.5F, kNan}},
      {2, 0, 0.5F, {kInfinity, 0.0F, 0.0F, 1.0F}},
      {3, 0, 0.5F, {-kInfinity, -1.0F, kInfinity, 7.0F}},
      {4, 0, 0.5F, {0.5F, 0.5F, 0.5F, -3.0F}},
      {5, 0, 0.5F, {0.5F, 0.5F, 0.5F, format == VITRAIL_NODE_HDR ? 5e-11F : 0.000007F}},
      {6, 0, 0.5F, {kNan, -1.0F, 0.0F, 0.0F}, VITRAIL_BLEND_PREMULTIPLIED},
      {7, 0, 0.5F, {0.0F, format != VITRAIL_NODE_HDR ? kFaint : 0.0F, 0.0F, 0.0F}, VITRAIL_BLEND_PREMULTIPLIED},
  };
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const PointResult result = backend.makeHost(desc)->draw(points);
  EXPECT_EQ(result.pixels[0][0], 0.0F);
  EXPECT_EQ(result.pixels[1], desc.behind);
  EXPECT_EQ(result.pixels[2], (FloatColor{brightest, 0.0F, 0.0F, 1.0F}));
  EXPECT_EQ(result.pixels[3], (FloatColor{0.0F, 0.0F, brightest, 1.0F}));
  EXPECT_EQ(result.pixels[4], desc.behind);
  EXPECT_EQ(result.pixels[5], desc.behind);
  for (std::size_t i = 6; i < result.pixels.size(); ++i) EXPECT_EQ(result.pixels[i], desc.behind);
  // Stored alpha 0 is neither stored nor counted: points 1, 4, 5, 6 and 7.
  EXPECT_EQ(result.stats.fragmentsRequested, 3U);
}

TEST_P(ListsTest, HostileColoursStayInTheirPixel) {
  for (const VitrailNodeFormat format : nodeFormats(1)) {
    for (const VitrailListBuild listBuild : kListBuilds) {
      SCOPED_TRACE("format " + std::to_string(format) + ", list build " + std::to_string(listBuild));
      expectHostileColoursApart(backend(), format, listBuild);
    }
  }
}

// What becomes of a point at such a depth is the rasterizer's business; all other pixels are as they would be.
TEST_P(ListsTest, HostileDepthsStayInTheirPixel) {
  for (const VitrailNodeFormat format : nodeFormats(1)) {
    HostDesc desc;
    desc.nodes = format;
    std::vector<Point> points = randomLists(desc, {0, 4, 20, 40}, 12);
    const Expected expected = expectedFrame(desc, points);
    for (const float depth : {kNan, kInfinity, -kInfinity, 1e30F, -0.0F}) {
      points.push_back({0, 0, depth, {0.5F, 0.25F, 1.0F, 0.5F}});
    }
    desc.capacity = static_cast<std::uint32_t>(points.size());
    const PointResult result = draw(desc, ordered(points, Order::Shuffled));
    EXPECT_EQ(result.stats.complete, 1U);
    EXPECT_LT(largestError(std::span(result.pixels).subspan(1), std::span(expected.pixels).subspan(1)),
              kBlendTolerance);
    for (const float channel : result.pixels[0]) EXPECT_TRUE(channel >= 0.0F && channel <= 1.0F);
  }
}

// How far colour channels may be off on the curve, and alpha; `hdr` has floats.
struct Rounding {
  std::array<double, 3> color{};
  double alpha = 0.0;
};

Rounding roundingOf(VitrailNodeFormat format, std::uint32_t samples, VitrailListBuild listBuild) {
  switch (format) {
    case VITRAIL_NODE_STANDARD:
      if (listBuild == VITRAIL_LIST_BUILD_COMPUTE && samples == 1)
        return {{0.7 / 255, 0.7 / 255, 0.9 / 255}, 0.5 / 255};
      return {{0.5 / 255, 0.5 / 255, 0.5 / 255}, 0.5 / 255};
    case VITRAIL_NODE_COMPACT:
      if (samples > 1) return {{0.5 / 31, 0.5 / 31, 0.5 / 31}, 0.5 / 31};
      return {{0.5 / 31, 0.5 / 63, 0.5 / 31}, 0.5 / 63};
    default:
      return {{}, 1.0 / 65535};
  }
}

// One fragment a pixel over black: the picture is the stored colour, premultiplied, or white times the stored alpha.
// Values lie anywhere between two steps; the bounds are those of VitrailNodeFormat.
void expectStatedRounding(Backend& backend, HostDesc desc) {
  constexpr std::uint32_t kValues = 2048;
  desc.width = kValues;
  desc.height = 2;
  const bool hdr = desc.nodes == VITRAIL_NODE_HDR;
  std::vector<Point> points;
  std::vector<double> wanted;
  for (std::uint32_t i = 0; i < kValues; ++i) {
    const double step = (i + 0.37) / kValues;
    wanted.push_back(hdr ? std::exp2(step * 38.0 - 22.0) : srgbToLinear(step)); // hdr: 2^-22 to 2^16
    const auto grey = static_cast<float>(wanted.back());
    points.push_back({i, 0, 0.5F, {grey, grey, grey, 1.0F}, VITRAIL_BLEND_PREMULTIPLIED});
    points.push_back({i, 1, 0.5F, {1.0F, 1.0F, 1.0F, static_cast<float>(step)}});
  }
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const PointResult result = backend.makeHost(desc)->draw(points);
  const Rounding rounding = roundingOf(desc.nodes, desc.samples, desc.listBuild);
  for (std::uint32_t i = 0; i < kValues; ++i) {
    for (unsigned c = 0; c < 3; ++c) {
      const double got = result.pixels[i][c];
      if (hdr) {
        ASSERT_NEAR(got, wanted[i], std::max(wanted[i] * 0x1p-10, 0x1p-24)) << i;
      } else {
        ASSERT_NEAR(linearToSrgb(got), linearToSrgb(wanted[i]), rounding.color[c] + 2e-5) << i;
      }
    }
    ASSERT_NEAR(double{result.pixels[kValues + i][0]}, (i + 0.37) / kValues, rounding.alpha + 1e-6) << i;
  }
}

TEST_P(ListsTest, ColourAndAlphaKeepTheirStatedRounding) {
  for (const std::uint32_t samples : sampleCounts(features())) {
    for (const VitrailNodeFormat format : nodeFormats(samples)) {
      for (const VitrailListBuild listBuild : kListBuilds) {
        SCOPED_TRACE(std::to_string(samples) + " samples, format " + std::to_string(format) + ", list build " +
                     std::to_string(listBuild));
        HostDesc desc;
        desc.nodes = format;
        desc.samples = samples;
        desc.listBuild = listBuild;
        expectStatedRounding(backend(), desc);
      }
    }
  }
}

// Wherever between two steps they lie, colours come out of `standard` nodes as the reference rounds them, and whole
// steps as they are.
TEST_P(ListsTest, ColoursThatComputeEncodesAreRoundedAsTheReferenceDoes) {
  HostDesc desc;
  desc.listBuild = VITRAIL_LIST_BUILD_COMPUTE;
  desc.width = 256;
  desc.height = 33;
  std::vector<Point> points;
  for (std::uint32_t i = 0; i < desc.width * desc.height; ++i) {
    const std::uint32_t step = i % 256;
    const std::uint32_t part = i / 256; // of 32 between two steps
    const auto value = static_cast<float>(srgbToLinear(std::min((step + part / 32.0) / 255.0, 1.0)));
    points.push_back({step, part, 0.5F, {value, value, value, 1.0F}, VITRAIL_BLEND_PREMULTIPLIED});
  }
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const PointResult result = draw(desc, points);
  EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), 1e-6);
  for (std::uint32_t step = 0; step < 256; ++step) {
    for (unsigned c = 0; c < 3; ++c) EXPECT_NEAR(double{result.pixels[step][c]}, srgbToLinear(step / 255.0), 1e-6);
  }
}

TEST_P(ListsTest, SurfacesBrighterThanOneSurviveInHdr) {
  HostDesc desc;
  desc.nodes = VITRAIL_NODE_HDR;
  const std::vector<Point> points = {{0, 0, 0.2F, {0.0F, 0.0F, 0.0F, 0.5F}}, {0, 0, 0.7F, {40.0F, 2.0F, 0.0F, 1.0F}}};
  desc.capacity = 2;
  const FloatColor pixel = draw(desc, points).pixels[0];
  EXPECT_NEAR(pixel[0], 20.0F, 1e-3F); // 0.5 is nearly (46340/65535)^2
  EXPECT_NEAR(pixel[1], 1.0F, 1e-4F);
}

// Depths nearer than what the format tells apart count as equal, and the rest of the node orders them: as the reference
// says, whose rounding the unit tests hold to the header.
TEST_P(ListsTest, CompactDepthsAreToldApartAsStated) {
  for (const VitrailDepthOrder depthOrder : {VITRAIL_DEPTH_NEAREST_IS_ZERO, VITRAIL_DEPTH_NEAREST_IS_ONE}) {
    HostDesc desc;
    desc.nodes = VITRAIL_NODE_COMPACT;
    desc.depthOrder = depthOrder;
    desc.width = 64;
    desc.height = 64;
    std::vector<Point> points;
    for (std::uint32_t i = 0; i < desc.width * desc.height; ++i) {
      const float n = std::exp2(-32.0F * static_cast<float>(i) / 4096.0F);
      const float other = n * (1.0F + 0x1p-14F * static_cast<float>(i % 17)); // up to two codes apart
      for (const float nearness : {n, std::min(other, 1.0F)}) {
        const float depth = depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? nearness : 1.0F - nearness;
        const bool first = nearness == n;
        points.push_back(
            {i % desc.width, i / desc.width, depth, {first ? 1.0F : 0.0F, 0.0F, first ? 0.0F : 1.0F, 1.0F}});
      }
    }
    desc.capacity = static_cast<std::uint32_t>(points.size());
    const PointResult result = draw(desc, points);
    EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), kBlendTolerance);
  }
}

// How collecting shaders may be: each kind turns away what does not suit it in its own way.
struct Kind {
  VitrailListBuild listBuild;
  bool addresses;
  ShaderKind shader;
};

std::vector<Kind> kindsOf(const Features& features) {
  std::vector<Kind> kinds;
  for (const ShaderKind shader : {ShaderKind::Usual, ShaderKind::ForCpu}) {
    for (const bool addresses : {false, true}) {
      if (addresses && !features.addresses) continue;
      kinds.push_back({VITRAIL_LIST_BUILD_FRAGMENT, addresses, shader});
      kinds.push_back({VITRAIL_LIST_BUILD_COMPUTE, addresses, shader});
    }
  }
  return kinds;
}

std::string describe(const Kind& kind) {
  return "list build " + std::to_string(kind.listBuild) + (kind.addresses ? ", by address" : ", by binding") +
         (kind.shader == ShaderKind::ForCpu ? ", for CPU drivers" : "");
}

// A shader that is specialized for another target stores nothing there, and says so.
TEST_P(ListsTest, AShaderOfAnotherTargetStoresNothing) {
  for (const Kind& kind : kindsOf(features())) {
    SCOPED_TRACE(describe(kind));
    HostDesc desc;
    desc.capacity = 4;
    desc.behind = {0.5F, 0.25F, 0.75F, 1.0F};
    desc.listBuild = kind.listBuild;
    desc.addresses = kind.addresses;
    desc.shader = kind.shader;
    const Point point = {0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}};
    desc.specialized = true;
    EXPECT_EQ(draw(desc, std::span(&point, 1)).stats.fragmentsStored, 1U);
    desc.specializedFor = VITRAIL_NODE_HDR;
    desc.overflow = VITRAIL_OVERFLOW_SKIP;
    const PointResult result = draw(desc, std::span(&point, 1));
    EXPECT_EQ(result.stats.fragmentsStored, 0U);
    EXPECT_EQ(result.stats.fragmentsMissing, 1U);
    EXPECT_EQ(result.stats.complete, 0U);
    EXPECT_EQ(result.pixels[0], desc.behind);
    // One for a target that keeps sums does not write them where there are none.
    desc.specializedFor.reset();
    desc.specializedForOverflow = VITRAIL_OVERFLOW_APPROXIMATE;
    desc.guarded = true;
    const std::vector<Point> points = randomLists(desc, std::vector<std::uint32_t>(64, 1), 2);
    const auto host = makeHost(desc);
    EXPECT_EQ(host->draw(points).stats.fragmentsMissing, points.size());
    EXPECT_TRUE(host->guardsUntouched());
    for (const std::uint32_t word : host->words(&StorageLayout::sums)) EXPECT_EQ(word, PointHost::kGuard);
  }
}

// A shader that was compiled for one kind of target draws there what every shader does, and stores nothing elsewhere.
TEST_P(ListsTest, AShaderForOneKindOfTargetSuitsNoOther) {
  HostDesc desc;
  desc.behind = {0.5F, 0.25F, 0.75F, 1.0F};
  desc.overflow = VITRAIL_OVERFLOW_SKIP;
  const std::vector<Point> points = randomLists(desc, {0, 1, 5, 20, 3}, 9);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const PointResult usual = draw(desc, points);
  desc.shader = ShaderKind::Narrow;
  const PointResult narrow = draw(desc, points);
  EXPECT_TRUE(narrow.pixels == usual.pixels);
  EXPECT_EQ(narrow.stats.complete, 1U);
  std::vector<HostDesc> others(4, desc);
  others[0].nodes = VITRAIL_NODE_HDR;
  others[1].overflow = VITRAIL_OVERFLOW_APPROXIMATE;
  others[2].listBuild = VITRAIL_LIST_BUILD_COMPUTE;
  others[3].userWords = true;
  for (const HostDesc& other : others) {
    const PointResult result = draw(other, points);
    EXPECT_EQ(result.stats.fragmentsStored, 0U);
    EXPECT_EQ(result.stats.fragmentsMissing, usual.stats.fragmentsStored);
    EXPECT_EQ(result.stats.complete, 0U);
  }
}

// Nodes that were given to such a shader are on no list that shows: what is left of other frames in them stays unseen.
TEST_P(ListsTest, NodesThatNobodyWroteAreNotSeen) {
  for (const Kind& kind : kindsOf(features())) {
    SCOPED_TRACE(describe(kind));
    HostDesc desc;
    desc.behind = {0.5F, 0.25F, 0.75F, 1.0F};
    desc.listBuild = kind.listBuild;
    desc.addresses = kind.addresses;
    desc.shader = kind.shader;
    desc.specialized = true;
    desc.specializedForListBuild =
        kind.listBuild == VITRAIL_LIST_BUILD_COMPUTE ? VITRAIL_LIST_BUILD_FRAGMENT : VITRAIL_LIST_BUILD_COMPUTE;
    desc.guarded = true; // the nodes hold guard words at first
    const std::vector<Point> points = randomLists(desc, std::vector<std::uint32_t>(64, 1), 2);
    for (const std::uint32_t capacity : {30U, 200U}) {
      desc.capacity = capacity;
      const auto host = makeHost(desc);
      const PointResult result = host->draw(points);
      EXPECT_EQ(result.stats.fragmentsRequested, points.size());
      EXPECT_EQ(result.stats.fragmentsStored, 0U);
      EXPECT_EQ(result.stats.complete, 0U);
      EXPECT_EQ(result.stats.coveredPixels, 0U);
      // Every pixel has one fragment, and its sums are that.
      EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), 0x1p-13);
      EXPECT_TRUE(host->guardsUntouched());
    }
  }
}

// The fragment that is first to find no node is a stranger's: the frame is blended from sums all the same, which leave
// nothing behind.
TEST_P(ListsTest, StrangersDoNotHideThatAFrameOverflows) {
  for (const Way& way : everyWay(features(), 1)) {
    SCOPED_TRACE(way.name);
    HostDesc desc;
    desc.behind = {0.5F, 0.25F, 0.75F, 1.0F};
    desc.strangersFor = VITRAIL_OVERFLOW_SKIP;
    apply(way, desc);
    std::vector<Point> points = randomLists(desc, std::vector<std::uint32_t>(40, 1), 2);
    const Expected expected = expectedFrame(desc, points);
    points.insert(points.begin() + 20, {50 % desc.width, 50 / desc.width, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}});
    points[20].stranger = true;
    for (const std::uint32_t capacity : {20U, 30U}) { // it finds none, or is given one
      desc.capacity = capacity;
      desc.addresses = features().addresses && capacity == 20U;
      const auto host = makeHost(desc);
      for (int frame = 0; frame < 2; ++frame) {
        const PointResult result = host->draw(points);
        EXPECT_EQ(result.stats.complete, 0U);
        EXPECT_EQ(result.stats.fragmentsRequested, points.size());
        EXPECT_LE(result.stats.fragmentsStored, capacity);
        EXPECT_LT(largestError(result.pixels, expected.pixels), 0x1p-13); // sums of one layer, none of the stranger's
      }
    }
  }
}

// What a host builds its shaders for is what its target is, whatever that is on this device.
TEST_P(ListsTest, ShadersForTheDefaultListBuildSuitTheirTarget) {
  HostDesc desc;
  desc.width = 16;
  desc.height = 8;
  desc.listBuild = VITRAIL_LIST_BUILD_DEFAULT;
  desc.specialized = true;
  const std::vector<Point> points = randomLists(desc, {0, 1, 5, 20, 3}, 7);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  expectLikeReference(draw(desc, points), expectedFrame(desc, points));
}

TEST_P(ListsTest, StatisticsBelongToTheirFrame) {
  HostDesc desc;
  desc.capacity = 10;
  const auto host = makeHost(desc);
  const std::vector<Point> points = {{0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}}, {0, 0, 0.6F, {1.0F, 1.0F, 1.0F, 0.5F}}};
  EXPECT_FALSE(host->stats(0));
  EXPECT_EQ(host->draw(std::span(points).first(1)).stats.layersMax, 1U);
  EXPECT_EQ(host->draw(points).stats.layersMax, 2U);
  ASSERT_TRUE(host->stats(0));
  EXPECT_EQ(host->stats(0)->fragmentsStored, 1U);
  EXPECT_FALSE(host->stats(2));
  host->draw({});
  EXPECT_TRUE(host->stats(0)); // a host may read it when it has recorded the frame that is two later
  EXPECT_TRUE(host->stats(1));
  host->draw({}); // frame 3 takes the slot of frame 0
  EXPECT_FALSE(host->stats(0));
  EXPECT_TRUE(host->stats(1));
}

// Two frames in one command buffer, of the same target, into two images: the second must wait for the first wherever
// they share memory. Synchronization validation is the judge, and the pictures are.
TEST_P(ListsTest, FramesInOneCommandBufferDoNotMeet) {
  for (const std::uint32_t samples : sampleCounts(features())) {
    for (const Way& way : everyWay(features(), samples)) {
      if (samples > 1 && way.stencilMark) continue;
      SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name);
      HostDesc desc;
      desc.samples = samples;
      apply(way, desc);
      const std::vector<Point> first = randomLists(desc, {3, 0, 100, 17, 1}, 1);
      const std::vector<Point> second = randomLists(desc, {0, 5, 2, 400, 30}, 2);
      desc.capacity = static_cast<std::uint32_t>(std::max(first.size(), second.size()));
      const auto host = makeHost(desc);
      for (int repetition = 0; repetition < 2; ++repetition) {
        const std::vector<PointResult> results = host->drawTogether({first, second});
        EXPECT_LT(largestError(results[0].pixels, expectedFrame(desc, first).pixels), kBlendTolerance);
        EXPECT_LT(largestError(results[1].pixels, expectedFrame(desc, second).pixels), kBlendTolerance);
        EXPECT_EQ(results[0].stats.fragmentsStored, first.size());
        EXPECT_EQ(results[1].stats.fragmentsStored, second.size());
        EXPECT_EQ(results[0].stats.layersMax, 100U);
        EXPECT_EQ(results[1].stats.layersMax, 400U);
      }
    }
  }
}

} // namespace
} // namespace vitrail::tests
