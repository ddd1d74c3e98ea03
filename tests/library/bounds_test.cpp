// What the library does where something is bounded: pools around what a frame needs, frames that overflow, a cap on the
// layers of a pixel. In each case the picture is stated, and does not depend on the order of arrival.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "../thorough.h"
#include "expected.h"

namespace vitrail::tests {
namespace {

class BoundsTest : public BackendTest {};
VITRAIL_ON_EVERY_BACKEND(BoundsTest);

TEST_P(BoundsTest, CapacitiesAroundTheNeedCountWhatIsMissing) {
  for (const std::uint32_t samples : sampleCounts(features())) {
    for (const VitrailNodeFormat format : nodeFormats(samples)) {
      if (samples > 1 && format == VITRAIL_NODE_HDR) continue; // its words are those of the other two
      HostDesc desc;
      desc.samples = samples;
      desc.nodes = format;
      desc.listBuild = format == VITRAIL_NODE_COMPACT ? VITRAIL_LIST_BUILD_FRAGMENT : VITRAIL_LIST_BUILD_COMPUTE;
      desc.shader = samples > 1 ? ShaderKind::ForCpu : ShaderKind::Usual;
      desc.guarded = true;
      PointVariety variety;
      variety.coverage = samples > 1;
      const std::vector<Point> points =
          ordered(randomLists(desc, {0, 1, 2, 17, 40, 100, 3, 900}, 3, variety), Order::Shuffled);
      const Expected expected = expectedFrame(desc, points);
      const auto need = static_cast<std::uint32_t>(expected.fragments);
      for (const std::uint32_t capacity : {1U, need / 2, need - 1, need, need + 1}) {
        SCOPED_TRACE(std::to_string(samples) + " samples, format " + std::to_string(format) + ", capacity " +
                     std::to_string(capacity));
        desc.capacity = capacity;
        const auto host = makeHost(desc);
        for (int repetition = 0; repetition < 2; ++repetition) { // the second frame starts from an overflowed one
          const PointResult result = host->draw(points);
          const std::uint32_t stored = std::min(capacity, need);
          EXPECT_EQ(result.stats.fragmentsRequested, need);
          EXPECT_EQ(result.stats.fragmentsStored, stored);
          EXPECT_EQ(result.stats.fragmentsMissing, need - stored);
          EXPECT_EQ(result.stats.nodeCapacity, capacity);
          EXPECT_EQ(result.stats.complete, stored == need ? 1U : 0U);
          EXPECT_TRUE(host->guardsUntouched());
          for (const auto& pixel : result.pixels) {
            for (const float channel : pixel) EXPECT_TRUE(channel >= 0.0F && channel <= 1.0001F) << channel;
          }
          EXPECT_TRUE(stored < need || largestError(result.pixels, expected.pixels) < kTolerance);
        }
      }
    }
  }
}

// The counter of a frame with 15 times 2^28 requests is wound back; no node is handed out twice, no request is
// forgotten.
TEST_P(BoundsTest, RequestsBeyond32BitsAreCountedAndTakeNoNode) {
  for (const VitrailOverflow overflow : {VITRAIL_OVERFLOW_APPROXIMATE, VITRAIL_OVERFLOW_SKIP}) {
    HostDesc desc;
    desc.guarded = true;
    desc.capacity = 8;
    desc.overflow = overflow;
    desc.listBuild = overflow == VITRAIL_OVERFLOW_SKIP ? VITRAIL_LIST_BUILD_COMPUTE : VITRAIL_LIST_BUILD_FRAGMENT;
    desc.requestedBefore = layout::VITRAIL_WRAP_AT - 7;
    const std::vector<Point> points = randomLists(desc, {0, 1, 2, 17, 40, 100}, 3);
    const auto host = makeHost(desc);
    const PointResult result = host->draw(points);
    EXPECT_EQ(result.stats.fragmentsRequested, std::uint64_t{desc.requestedBefore} + points.size());
    EXPECT_EQ(result.stats.fragmentsStored, desc.capacity);
    EXPECT_EQ(result.stats.fragmentsMissing, result.stats.fragmentsRequested - desc.capacity);
    EXPECT_EQ(result.stats.complete, 0U);
    EXPECT_TRUE(host->guardsUntouched());
    // However many more follow, the counter does not come round to nodes that are in use.
    const std::vector<std::uint32_t> control = host->words(&StorageLayout::control);
    EXPECT_EQ(control[offsetof(layout::VitrailControl, wraps) / sizeof(std::uint32_t)], 1U);
    EXPECT_LT(control[offsetof(layout::VitrailControl, requested) / sizeof(std::uint32_t)], layout::VITRAIL_WRAP_AT);
  }
}

// What a frame that overflowed must be: every pixel the weighted average of all its fragments, each with the share of
// the samples that it covers. Filters count with the mean of their channels' logarithms.
std::vector<Color> averagedPixels(const HostDesc& desc, const std::vector<Point>& points) {
  struct Sums {
    Color color{};
    double opacity = 0.0;
    double body = 0.0;    // -log2 of the transmittance of all that has a body
    double filters = 0.0; // of filters
  };
  const auto density = [](double t) { return std::clamp(-std::log2(std::max(t, 1e-9)), 0.0, 24.0); };
  std::vector<Sums> sums(std::size_t{desc.width} * desc.height);
  for (const Point& p : points) {
    const auto node =
        packNode(codingOf(desc), {{p.color[0], p.color[1], p.color[2], p.color[3]}, p.depth, p.blend, p.coverage});
    if (!node) continue;
    const Fragment stored = unpackNode(codingOf(desc), *node);
    double share = 0.0;
    for (std::uint32_t s = 0; s < desc.samples; ++s) share += stored.coverage >> s & 1U;
    share /= desc.samples;
    const Blended pair = blendOf(stored);
    Sums& sum = sums[std::size_t{p.y} * desc.width + p.x];
    for (unsigned c = 0; c < 3; ++c) {
      sum.color[c] += pair.color[c] * share;
      if (p.blend == VITRAIL_BLEND_MULTIPLY) sum.filters += density(pair.transmittance[c]) * share / 3.0;
    }
    sum.opacity += pair.color[3] * share;
    sum.body += density(pair.transmittance[3]) * share;
  }
  Color behind{};
  for (std::uint32_t s = 0; s < desc.samples; ++s) {
    const FloatColor here = behindAt(desc, s);
    for (unsigned c = 0; c < 4; ++c) behind[c] += double{here[c]} / desc.samples;
  }
  std::vector<Color> pixels;
  for (const Sums& sum : sums) {
    const double transmittance = std::exp2(-sum.body - sum.filters);
    const double scale = sum.opacity > 0.0 ? (1.0 - transmittance) / sum.opacity : 1.0;
    Color pixel{};
    for (unsigned c = 0; c < 3; ++c) pixel[c] = sum.color[c] * scale + transmittance * behind[c];
    pixel[3] = 1.0 - transmittance * (1.0 - behind[3]);
    pixels.push_back(pixel);
  }
  return pixels;
}

// A pool of half of what the frame needs: which half is stored depends on arrival, the picture does not.
TEST_P(BoundsTest, AFrameThatOverflowsIsBlendedApproximatelyAndAlwaysTheSame) {
  for (const std::uint32_t samples : sampleCounts(features())) {
    for (const Way& way : everyWay(features(), samples)) {
      SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name);
      HostDesc desc;
      desc.samples = samples;
      desc.behind = {0.1F, 0.8F, 0.3F, 1.0F};
      apply(way, desc);
      PointVariety variety;
      variety.coverage = samples > 1;
      const std::vector<Point> points = randomLists(desc, {0, 1, 2, 3, 5, 12, 17, 40, 90}, 17, variety);
      desc.capacity = static_cast<std::uint32_t>(points.size() / 2);
      const auto host = makeHost(desc);
      const PointResult forward = host->draw(points);
      EXPECT_EQ(forward.stats.complete, 0U);
      EXPECT_GT(forward.stats.fragmentsMissing, 0U);
      // A stencil mark rejects samples that nothing covers, which the average over the pixel would change a little.
      const bool marked = samples > 1 && way.stencilMark;
      EXPECT_LT(largestError(forward.pixels, averagedPixels(desc, points)), marked ? 0.2 : kSumTolerance);
      for (const Order order : {Order::Reversed, Order::Shuffled, Order::Forward}) {
        EXPECT_TRUE(host->draw(ordered(points, order)).pixels == forward.pixels) << "flickers";
      }
      // Two such frames in one command buffer share the sums.
      for (const PointResult& result : host->drawTogether({points, points})) {
        EXPECT_TRUE(result.pixels == forward.pixels) << "frames meet";
      }
      // A frame that fits is exact again.
      const std::vector<Point> few(points.begin(), points.begin() + 6);
      const PointResult fits = host->draw(few);
      EXPECT_EQ(fits.stats.complete, 1U);
      EXPECT_LT(largestError(fits.pixels, expectedFrame(desc, few).pixels), kTolerance);
    }
  }
}

// The memory of a fresh target holds anything. That its first frames were recorded says nothing about it.
TEST_P(BoundsTest, AFrameThatIsNeverSubmittedLeavesNothingBehind) {
  for (const Way& way : everyWay(features(), 1)) {
    SCOPED_TRACE(way.name);
    HostDesc desc;
    desc.behind = {0.1F, 0.8F, 0.3F, 1.0F};
    desc.guarded = true; // the memory holds guard words at first
    apply(way, desc);
    const std::vector<Point> points = randomLists(desc, {0, 1, 2, 3, 5, 12, 17, 40, 90}, 17);
    desc.capacity = static_cast<std::uint32_t>(points.size() / 2);
    const auto host = makeHost(desc);
    for (int frame = 0; frame < 3; ++frame) host->drop(points);
    const PointResult result = host->draw(points);
    EXPECT_GT(result.stats.fragmentsMissing, 0U);
    EXPECT_LT(largestError(result.pixels, averagedPixels(desc, points)), kSumTolerance);
    host->drop(points);
    EXPECT_TRUE(host->draw(points).pixels == result.pixels);
  }
}

// A fragment is encoded where its list is built, or where it is added to the sums if it found no node: the same bits.
TEST_P(BoundsTest, ColoursBetweenStepsOverflowAlike) {
  for (const bool addresses : {false, true}) {
    if (addresses && !features().addresses) continue;
    HostDesc desc;
    desc.listBuild = VITRAIL_LIST_BUILD_COMPUTE;
    desc.addresses = addresses;
    desc.width = 64;
    desc.height = 64;
    std::vector<Point> points;
    for (std::uint32_t i = 0; i < 4 * desc.width * desc.height; ++i) {
      const auto channel = [&](std::uint32_t seed) { return static_cast<float>((i * seed) % 65521U) / 65520.0F; };
      points.push_back({i % 64, i / 64 % 64, channel(7919), {channel(31), channel(2741), channel(977), channel(5)}});
    }
    desc.capacity = static_cast<std::uint32_t>(points.size() / 2);
    const auto host = makeHost(desc);
    const PointResult forward = host->draw(points);
    EXPECT_GT(forward.stats.fragmentsMissing, 0U);
    for (const Order order : {Order::Reversed, Order::Shuffled}) {
      EXPECT_TRUE(host->draw(ordered(points, order)).pixels == forward.pixels);
    }
  }
}

TEST_P(BoundsTest, OtherBlendModesOverflowToo) {
  for (const VitrailNodeFormat format : nodeFormats(1)) {
    HostDesc desc;
    desc.nodes = format;
    desc.listBuild = format == VITRAIL_NODE_STANDARD ? VITRAIL_LIST_BUILD_COMPUTE : VITRAIL_LIST_BUILD_FRAGMENT;
    desc.behind = {0.5F, 0.5F, 0.5F, 1.0F};
    PointVariety variety;
    variety.blendModes = true;
    const std::vector<Point> points = randomLists(desc, {3, 9, 20, 33}, 41, variety);
    desc.capacity = 10;
    const auto host = makeHost(desc);
    const PointResult forward = host->draw(points);
    EXPECT_TRUE(host->draw(ordered(points, Order::Shuffled)).pixels == forward.pixels);
    for (const auto& pixel : forward.pixels) {
      for (const float channel : pixel) EXPECT_TRUE(channel >= 0.0F && channel < 50.0F);
    }
  }
}

// Exact for pixels with one layer of VITRAIL_BLEND_OVER, up to the step of the transmittance's logarithm.
TEST_P(BoundsTest, OneLayerOverflowsExactly) {
  HostDesc desc;
  desc.width = 64;
  desc.height = 4;
  desc.behind = {0.3F, 0.6F, 0.9F, 1.0F};
  const std::vector<Point> points = randomLists(desc, std::vector<std::uint32_t>(256, 1), 77);
  desc.capacity = 100;
  const PointResult result = draw(desc, points);
  EXPECT_EQ(result.stats.fragmentsMissing, 156U);
  EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), 0x1p-13);
}

TEST_P(BoundsTest, ASkippedFrameLeavesTheImageAsItIs) {
  for (const std::uint32_t samples : sampleCounts(features())) {
    for (const Way& way : everyWay(features(), samples)) {
      SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name);
      HostDesc desc;
      desc.samples = samples;
      desc.overflow = VITRAIL_OVERFLOW_SKIP;
      desc.behind = {0.123F, 45.6F, 1e-30F, 0.5F};
      desc.beforeResolve = {0.7F, 0.6F, 0.5F, 0.4F};
      apply(way, desc);
      const std::vector<Point> points = randomLists(desc, {1, 5, 20, 40, 100}, 1);
      desc.capacity = 20;
      const PointResult result = draw(desc, points);
      EXPECT_EQ(result.stats.complete, 0U);
      EXPECT_EQ(result.stats.fragmentsMissing, points.size() - 20);
      // A per-pixel resolve of several samples writes one image from others: the one that it writes stays.
      const bool other = samples > 1 && way.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_PIXEL;
      for (const auto& pixel : result.pixels) EXPECT_EQ(pixel, other ? desc.beforeResolve : desc.behind);
    }
  }
}

TEST_P(BoundsTest, TheNearestLayersAreExactAndTheOthersAveraged) {
  for (const std::uint32_t samples : sampleCounts(features())) {
    for (const Way& way : everyWay(features(), samples)) {
      for (const std::uint32_t maxLayers : {4U, 1U, 16U, 20U}) {
        const bool all = samples == 1 && way.resolve == VITRAIL_RESOLVE_COMPUTE;
        if (maxLayers != 4 && !all && (maxLayers != 20 || way.stencilMark || !isThorough())) continue; // of each some
        SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name + ", " + std::to_string(maxLayers) + " layers");
        HostDesc desc;
        desc.samples = samples;
        desc.maxLayers = maxLayers;
        desc.behind = {0.9F, 0.5F, 0.1F, 1.0F};
        apply(way, desc);
        PointVariety variety;
        variety.coverage = samples > 1;
        const std::vector<std::uint32_t> lengths = {0, 1, 3, 4, 5, 15, 16, 17, 20, 21, 32, 33, 64, 120};
        std::vector<Point> points = randomLists(desc, lengths, 29, variety);
        std::erase_if(points, [&](const Point& p) { return (p.coverage & ((1U << samples) - 1U)) == 0; });
        desc.capacity = static_cast<std::uint32_t>(points.size());
        const auto host = makeHost(desc);
        const PointResult forward = host->draw(points);
        EXPECT_LT(largestError(forward.pixels, expectedFrame(desc, points).pixels), kSumTolerance);
        for (const Order order : {Order::Reversed, Order::Shuffled}) {
          EXPECT_TRUE(host->draw(ordered(points, order)).pixels == forward.pixels) << "order changes the picture";
        }
        std::vector<std::uint32_t> layers(std::size_t{desc.width} * desc.height);
        for (const Point& p : points) ++layers[std::size_t{p.y} * desc.width + p.x];
        const auto over = std::count_if(layers.begin(), layers.end(), [&](std::uint32_t n) { return n > maxLayers; });
        EXPECT_EQ(forward.stats.approximatePixels, static_cast<std::uint32_t>(over));
        EXPECT_EQ(forward.stats.complete, 0U);
      }
    }
  }
}

// A cap that no pixel reaches changes nothing.
TEST_P(BoundsTest, ACapThatIsNotReachedIsExact) {
  for (const Way& way : everyWay(features(), 1)) {
    HostDesc desc;
    desc.maxLayers = 9;
    apply(way, desc);
    const std::vector<Point> points = randomLists(desc, {0, 1, 5, 9, 8}, 3);
    desc.capacity = static_cast<std::uint32_t>(points.size());
    const PointResult result = draw(desc, points);
    EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), kTolerance) << way.name;
    EXPECT_EQ(result.stats.complete, 1U);
    EXPECT_EQ(result.stats.approximatePixels, 0U);
  }
}

} // namespace
} // namespace vitrail::tests
