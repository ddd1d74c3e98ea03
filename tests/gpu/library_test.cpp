// The library through its public face, list by list: every list length against the reference resolve in double
// precision, pool capacities around what a frame needs, equal depths, hostile colours, statistics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "core/reference_resolve.h"
#include "gpu_fixture.h"
#include "point_host.h"

namespace vitrail::tests {
namespace {

class LibraryTest : public tool::test::GpuTest {};

enum class Order { Forward, Reversed, Shuffled };

std::vector<Point> ordered(std::vector<Point> points, Order order) {
  if (order == Order::Reversed) std::reverse(points.begin(), points.end());
  if (order == Order::Shuffled) {
    std::mt19937 random(11);
    std::shuffle(points.begin(), points.end(), random);
  }
  return points;
}

// `lengths[i]` fragments on pixel i of an image of the given width: random depths and colours, the nearest first. Every
// tenth depth repeats the one before, so that the rest of the node decides. Colours and alphas are on the format's
// grid, so that nothing is rounded; long lists get its thinnest layers, so that deep ones still matter.
std::vector<Point> lists(const std::vector<std::uint32_t>& lengths, std::uint32_t width, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto upTo = [&](std::uint32_t most) { return static_cast<std::uint32_t>(random() % (most + 1)); };
  const auto channel = [&] { return static_cast<float>(srgbToLinear(upTo(255) / 255.0)); };
  std::vector<Point> points;
  for (std::uint32_t i = 0; i < lengths.size(); ++i) {
    std::vector<float> depths(lengths[i]);
    for (float& depth : depths) depth = static_cast<float>(random() >> 8U) / 16777216.0F;
    std::sort(depths.begin(), depths.end());
    for (std::size_t k = 10; k < depths.size(); k += 10) depths[k] = depths[k - 1];
    const std::uint32_t alphas = lengths[i] > 300 ? 0 : lengths[i] > 40 ? 15 : 254;
    for (const float depth : depths) {
      const float alpha = static_cast<float>(1 + upTo(alphas)) / 255.0F;
      points.push_back({i % width, i / width, depth, {channel(), channel(), channel(), alpha}});
    }
  }
  return points;
}

// What the picture must be, from the points.
std::vector<Color> expectedPixels(const PointHostDesc& desc, const std::vector<Point>& points) {
  const bool nearestIsOne = desc.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
  std::vector<std::vector<StoredFragment>> stored(std::size_t{desc.width} * desc.height);
  for (const Point& p : points) {
    const Color color = {p.color[0], p.color[1], p.color[2], p.color[3]};
    stored[p.y * desc.width + p.x].push_back({packColor(color), packDepth(p.depth, nearestIsOne)});
  }
  const Color behind = {desc.behind[0], desc.behind[1], desc.behind[2], desc.behind[3]};
  std::vector<Color> pixels;
  pixels.reserve(stored.size());
  for (const auto& list : stored) pixels.push_back(resolveReference(list, behind, nearestIsOne));
  return pixels;
}

double largestError(const std::vector<std::array<float, 4>>& got, const std::vector<Color>& expected) {
  double worst = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (unsigned c = 0; c < 4; ++c) worst = std::max(worst, std::abs(double{got[i][c]} - expected[i][c]));
  }
  return worst;
}

// What single-precision blending and a device's pow() may add up to. A fragment at rank n of a list of 1/255 layers
// weighs 1/255 * (254/255)^n: a wrong one is seen down to rank 1,500.
constexpr double kTolerance = 1e-5;

TEST_F(LibraryTest, EveryListLengthMatchesTheReferenceInEveryOrder) {
  PointHostDesc desc;
  desc.width = 16;
  desc.height = 8;
  desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
  std::vector<std::uint32_t> lengths(68);
  std::iota(lengths.begin(), lengths.end(), 0U); // 0 to 67: every remainder of the sorting block, twice and more
  for (std::uint32_t longer : {127U, 128U, 129U, 255U, 256U, 700U, 1023U, 1025U, 5000U, 15000U})
    lengths.push_back(longer);
  const std::vector<Point> points = lists(lengths, desc.width, 5);
  desc.capacity = static_cast<std::uint32_t>(points.size());

  for (VitrailDepthOrder depthOrder : {VITRAIL_DEPTH_NEAREST_IS_ZERO, VITRAIL_DEPTH_NEAREST_IS_ONE}) {
    desc.depthOrder = depthOrder;
    PointHost host(gpu(), desc);
    const PointResult forward = host.draw(points);
    EXPECT_LT(largestError(forward.pixels, expectedPixels(desc, points)), kTolerance);
    EXPECT_EQ(forward.stats.exact, 1U);
    EXPECT_EQ(forward.stats.fragmentsStored, points.size());
    EXPECT_EQ(forward.stats.layersMax, 15000U);
    EXPECT_EQ(forward.stats.coveredPixels, lengths.size() - 1); // the first list is empty
    for (Order order : {Order::Reversed, Order::Shuffled}) {
      EXPECT_TRUE(host.draw(ordered(points, order)).pixels == forward.pixels) << "order changes the picture";
    }
  }
}

TEST_F(LibraryTest, TheNearestFragmentIsOnTop) {
  PointHostDesc desc;
  desc.capacity = 2;
  const std::vector<Point> points = {{3, 5, 0.25F, {1.0F, 0.0F, 0.0F, 1.0F}}, {3, 5, 0.75F, {0.0F, 1.0F, 0.0F, 1.0F}}};
  const std::array<float, 4> red = {1.0F, 0.0F, 0.0F, 1.0F};
  const std::array<float, 4> green = {0.0F, 1.0F, 0.0F, 1.0F};
  const std::size_t pixel = 5 * desc.width + 3;
  EXPECT_EQ(PointHost(gpu(), desc).draw(points).pixels[pixel], red);
  desc.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
  EXPECT_EQ(PointHost(gpu(), desc).draw(points).pixels[pixel], green);
}

TEST_F(LibraryTest, PixelsWithoutFragmentsKeepTheirBits) {
  PointHostDesc desc;
  desc.capacity = 1;
  desc.behind = {0.1F, 123.456F, 1e-30F, 0.3F};
  const PointResult result = PointHost(gpu(), desc).draw({});
  for (const auto& pixel : result.pixels) EXPECT_EQ(pixel, desc.behind);
  EXPECT_EQ(result.stats.exact, 1U);
  EXPECT_EQ(result.stats.coveredPixels, 0U);
  EXPECT_EQ(result.stats.layersMax, 0U);
}

TEST_F(LibraryTest, ATransparentBackgroundEndsPremultiplied) {
  PointHostDesc desc;
  desc.capacity = 1;
  desc.behind = {0.0F, 0.0F, 0.0F, 0.0F};
  const Point point = {0, 0, 0.5F, {1.0F, 1.0F, 0.0F, 51.0F / 255.0F}};
  const auto pixel = PointHost(gpu(), desc).draw(std::span(&point, 1)).pixels[0];
  EXPECT_NEAR(pixel[0], 0.2F, 1e-6F);
  EXPECT_NEAR(pixel[1], 0.2F, 1e-6F);
  EXPECT_NEAR(pixel[2], 0.0F, 1e-6F);
  EXPECT_NEAR(pixel[3], 0.2F, 1e-6F);
}

// Thousands of equal fragments between others: sorting must neither lose nor repeat one.
TEST_F(LibraryTest, ManyEqualFragmentsAreAllBlendedOnce) {
  PointHostDesc desc;
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
  PointHost host(gpu(), desc);
  const PointResult result = host.draw(ordered(points, Order::Shuffled));
  EXPECT_LT(largestError(result.pixels, expectedPixels(desc, points)), 1e-4);
  EXPECT_TRUE(host.draw(points).pixels == result.pixels);
}

TEST_F(LibraryTest, EqualDepthsAreOrderedByTheNodeAndNotByArrival) {
  PointHostDesc desc;
  desc.width = 1;
  desc.height = 1;
  std::vector<Point> points;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const auto v = static_cast<float>(i) / 40.0F;
    points.push_back({0, 0, 0.5F, {v, 1.0F - v, 0.3F, 0.4F}});
  }
  desc.capacity = static_cast<std::uint32_t>(points.size());
  PointHost host(gpu(), desc);
  const PointResult forward = host.draw(points);
  EXPECT_LT(largestError(forward.pixels, expectedPixels(desc, points)), kTolerance);
  EXPECT_TRUE(host.draw(ordered(points, Order::Reversed)).pixels == forward.pixels);
  EXPECT_TRUE(host.draw(ordered(points, Order::Shuffled)).pixels == forward.pixels);
}

TEST_F(LibraryTest, CapacitiesAroundTheNeedCountWhatIsMissing) {
  const std::vector<std::uint32_t> lengths = {0, 1, 2, 17, 40, 100, 3, 900};
  const std::vector<Point> points = ordered(lists(lengths, 8, 3), Order::Shuffled);
  const auto need = static_cast<std::uint32_t>(points.size());
  for (const std::uint32_t capacity : {0U, 1U, need / 2, need - 1, need, need + 1}) {
    PointHostDesc desc;
    desc.capacity = capacity;
    PointHost host(gpu(), desc);
    for (int repetition = 0; repetition < 2; ++repetition) { // the second frame starts from an overflowed one
      const PointResult result = host.draw(points);
      const std::uint32_t stored = std::min(capacity, need);
      EXPECT_EQ(result.stats.fragmentsRequested, need) << "capacity " << capacity;
      EXPECT_EQ(result.stats.fragmentsStored, stored) << "capacity " << capacity;
      EXPECT_EQ(result.stats.fragmentsMissing, need - stored) << "capacity " << capacity;
      EXPECT_EQ(result.stats.exact, stored == need ? 1U : 0U) << "capacity " << capacity;
      EXPECT_TRUE(host.guardsUntouched()) << "capacity " << capacity;
      for (const auto& pixel : result.pixels) {
        for (const float channel : pixel) EXPECT_TRUE(channel >= 0.0F && channel <= 1.0F);
      }
      if (stored == need) {
        EXPECT_LT(largestError(result.pixels, expectedPixels(desc, points)), kTolerance);
      }
    }
  }
}

// Mesa's CPU driver ends a shader's loops after 65,535 turns in total: a list that it cuts short must be reported, not
// blended silently wrong. On a GPU the same list is exact.
TEST_F(LibraryTest, AListThatTheDriverCutsIsReported) {
  PointHostDesc desc;
  std::vector<Point> points = lists({300000U, 3U}, desc.width, 9);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const PointResult result = PointHost(gpu(), desc).draw(points);
  EXPECT_EQ(result.stats.fragmentsMissing, 0U);
  EXPECT_EQ(result.stats.exact == 1U, result.stats.cutPixels == 0U);
  if (result.stats.exact == 1U) {
    EXPECT_LT(largestError(result.pixels, expectedPixels(desc, points)), kTolerance);
  } else {
    EXPECT_EQ(result.stats.cutPixels, 1U);
  }
}

TEST_F(LibraryTest, HostileColoursStayInTheirPixel) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  PointHostDesc desc;
  desc.behind = {0.5F, 0.5F, 0.5F, 1.0F};
  const std::vector<Point> points = {
      {0, 0, 0.5F, {kNan, 0.5F, 0.5F, 1.0F}},      {1, 0, 0.5F, {0.5F, 0.5F, 0.5F, kNan}},
      {2, 0, 0.5F, {kInfinity, 0.0F, 0.0F, 1.0F}}, {3, 0, 0.5F, {-kInfinity, -1.0F, 2.0F, 7.0F}},
      {4, 0, 0.5F, {0.5F, 0.5F, 0.5F, -3.0F}},     {5, 0, 0.5F, {0.5F, 0.5F, 0.5F, 0.001F}},
  };
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const PointResult result = PointHost(gpu(), desc).draw(points);
  EXPECT_EQ(result.pixels[0][0], 0.0F);
  EXPECT_EQ(result.pixels[1], desc.behind);
  EXPECT_EQ(result.pixels[2], (std::array<float, 4>{1.0F, 0.0F, 0.0F, 1.0F}));
  EXPECT_EQ(result.pixels[3], (std::array<float, 4>{0.0F, 0.0F, 1.0F, 1.0F}));
  EXPECT_EQ(result.pixels[4], desc.behind);
  EXPECT_EQ(result.pixels[5], desc.behind);
  for (std::size_t i = points.size(); i < result.pixels.size(); ++i) EXPECT_EQ(result.pixels[i], desc.behind);
  // Stored alpha 0 is neither stored nor counted: points 1, 4 and 5.
  EXPECT_EQ(result.stats.fragmentsRequested, 3U);
}

TEST_F(LibraryTest, ColourAndAlphaKeepTheirStatedRounding) {
  // One fragment a pixel over black: the picture is the stored colour times the stored alpha.
  PointHostDesc desc;
  desc.width = 256;
  desc.height = 2;
  std::vector<Point> points;
  for (std::uint32_t i = 0; i < 256; ++i) {
    const auto grey = static_cast<float>(srgbToLinear((static_cast<double>(i) + 0.3) / 255.3));
    points.push_back({i, 0, 0.5F, {grey, grey, grey, 1.0F}});
    points.push_back({i, 1, 0.5F, {1.0F, 1.0F, 1.0F, (static_cast<float>(i) + 0.3F) / 255.3F}});
  }
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const PointResult result = PointHost(gpu(), desc).draw(points);
  for (std::uint32_t i = 0; i < 256; ++i) {
    const double wanted = (i + 0.3) / 255.3;
    EXPECT_NEAR(linearToSrgb(double{result.pixels[i][0]}), wanted, 0.5 / 255.0 + 2e-5) << i;
    EXPECT_NEAR(double{result.pixels[256 + i][0]}, wanted, 0.5 / 255.0 + 1e-6) << i;
  }
}

TEST_F(LibraryTest, StatisticsBelongToTheirFrame) {
  PointHostDesc desc;
  desc.capacity = 10;
  PointHost host(gpu(), desc);
  const std::vector<Point> points = {{0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}}, {0, 0, 0.6F, {1.0F, 1.0F, 1.0F, 0.5F}}};
  VitrailStats stats{};
  EXPECT_EQ(host.target().readStats(0, stats), VK_NOT_READY);
  EXPECT_EQ(host.draw(std::span(points).first(1)).stats.layersMax, 1U);
  EXPECT_EQ(host.draw(points).stats.layersMax, 2U);
  ASSERT_EQ(host.target().readStats(0, stats), VK_SUCCESS);
  EXPECT_EQ(stats.fragmentsStored, 1U);
  EXPECT_EQ(host.target().readStats(2, stats), VK_NOT_READY);
  host.draw({}); // frame 2 takes the slot of frame 0
  EXPECT_EQ(host.target().readStats(0, stats), VK_NOT_READY);
  EXPECT_EQ(host.target().readStats(1, stats), VK_SUCCESS);
}

// Two frames in one command buffer, of the same target, into two images: the second must wait for the first wherever
// they share memory. Synchronization validation is the judge, and the pictures are.
TEST_F(LibraryTest, FramesInOneCommandBufferDoNotMeet) {
  PointHostDesc desc;
  const std::vector<Point> first = lists({3, 0, 100, 17, 1}, desc.width, 1);
  const std::vector<Point> second = lists({0, 5, 2, 400, 30}, desc.width, 2);
  desc.capacity = static_cast<std::uint32_t>(std::max(first.size(), second.size()));
  PointHost host(gpu(), desc);
  for (int repetition = 0; repetition < 3; ++repetition) {
    const std::vector<PointResult> results = host.drawTogether({first, second});
    EXPECT_LT(largestError(results[0].pixels, expectedPixels(desc, first)), kTolerance);
    EXPECT_LT(largestError(results[1].pixels, expectedPixels(desc, second)), kTolerance);
    EXPECT_EQ(results[0].stats.fragmentsStored, first.size());
    EXPECT_EQ(results[1].stats.fragmentsStored, second.size());
    EXPECT_EQ(results[0].stats.layersMax, 100U);
    EXPECT_EQ(results[1].stats.layersMax, 400U);
  }
}

TEST_F(LibraryTest, WrongDescriptionsAreRefusedWithAReason) {
  struct Collected {
    std::string last;
  } collected;
  VitrailContextDesc contextDesc{};
  VitrailContext none = nullptr;
  EXPECT_EQ(vitrailCreateContext(&contextDesc, &none), VK_ERROR_INITIALIZATION_FAILED);
  contextDesc.instance = gpu().instance();
  contextDesc.physicalDevice = gpu().physicalDevice();
  contextDesc.device = gpu().device();
  contextDesc.getInstanceProcAddr = vkGetInstanceProcAddr;
  contextDesc.log = [](VitrailLogSeverity, const char* message, void* user) {
    static_cast<Collected*>(user)->last = message;
  };
  contextDesc.logUser = &collected;
  Context context;
  ASSERT_EQ(Context::create(contextDesc, context), VK_SUCCESS);

  const auto refused = [&](const VitrailTargetDesc& desc, VkResult code, const char* word) {
    collected.last.clear();
    Target target;
    EXPECT_EQ(Target::create(context, desc, target), code) << word;
    EXPECT_FALSE(target) << word;
    EXPECT_NE(collected.last.find(word), std::string::npos) << "the log says: " << collected.last;
  };
  VitrailTargetDesc desc{};
  const VkImageView view = VK_NULL_HANDLE; // never reached
  desc.colorViews = &view;
  desc.colorViewCount = 1;
  refused(desc, VK_ERROR_INITIALIZATION_FAILED, "extent");
  desc.extent = {64, 64};
  desc.colorViewCount = 0;
  refused(desc, VK_ERROR_INITIALIZATION_FAILED, "colour views");
  desc.colorViewCount = VITRAIL_MAX_COLOR_VIEWS + 1;
  refused(desc, VK_ERROR_INITIALIZATION_FAILED, "colour views");
  desc.colorViewCount = 1;
  desc.colorFormat = VK_FORMAT_B8G8R8A8_SRGB;
  refused(desc, VK_ERROR_FORMAT_NOT_SUPPORTED, "colorFormat");
  desc.colorFormat = VK_FORMAT_UNDEFINED;
  desc.framesInFlight = VITRAIL_MAX_FRAMES_IN_FLIGHT + 1;
  refused(desc, VK_ERROR_INITIALIZATION_FAILED, "framesInFlight");
  desc.framesInFlight = 0;
  desc.nodeFormat = static_cast<VitrailNodeFormat>(7);
  refused(desc, VK_ERROR_INITIALIZATION_FAILED, "nodeFormat");
  desc.nodeFormat = VITRAIL_NODE_STANDARD;
  const std::uint32_t most = context.maxNodeCapacity(VITRAIL_NODE_STANDARD);
  if (most < std::numeric_limits<std::uint32_t>::max() - 1) {
    desc.nodeCapacity = most + 1;
    refused(desc, VK_ERROR_OUT_OF_DEVICE_MEMORY, "nodeCapacity");
  }
}

} // namespace
} // namespace vitrail::tests
