// The library with several samples: every sample blends its own list over its own opaque colour, in every node format
// and by every way to resolve, against the reference resolve; with coverage from before the depth test and from after
// it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../thorough.h"
#include "expected.h"

namespace vitrail::tests {
namespace {

// Opaque colours that differ from sample to sample, so that no two samples can change places unseen.
std::vector<FloatColor> colorsBySample(std::uint32_t samples) {
  std::vector<FloatColor> colors;
  colors.reserve(samples);
  for (std::uint32_t s = 0; s < samples; ++s) {
    const float v = std::exp2(-static_cast<float>(s));
    colors.push_back({v, 1.0F - 0.5F * v, s % 2 == 0 ? 0.25F : 0.75F, s % 3 == 0 ? 1.0F : 0.5F});
  }
  return colors;
}

std::vector<Color> asColors(const std::vector<FloatColor>& pixels) {
  std::vector<Color> colors;
  colors.reserve(pixels.size());
  for (const FloatColor& c : pixels) colors.push_back({c[0], c[1], c[2], c[3]});
  return colors;
}

class SamplesTest : public BackendTest {
 protected:
  // Calls `test` with hosts of every sample count that the device has: `standard` nodes in every way to resolve, the
  // other formats in one way of each kind, or, if not thorough, in one of these.
  template <typename Test>
  void forEveryHost(Test test) {
    for (const std::uint32_t samples : features().multisampled) {
      for (const VitrailNodeFormat format : nodeFormats(samples)) {
        for (const Way& way : everyWay(features(), samples)) {
          if (format != VITRAIL_NODE_STANDARD && (way.stencilMark || isPerPixelDraw(way))) continue;
          if (format != VITRAIL_NODE_STANDARD && !isThorough()) {
            const VitrailResolve tried =
                format == VITRAIL_NODE_HDR ? VITRAIL_RESOLVE_COMPUTE : VITRAIL_RESOLVE_FRAGMENT;
            if (way.resolve != tried) continue;
          }
          SCOPED_TRACE(std::to_string(samples) + " samples, format " + std::to_string(format) + ", " + way.name);
          HostDesc desc;
          desc.samples = samples;
          desc.nodes = format;
          desc.specialized = format != VITRAIL_NODE_STANDARD;
          desc.behindSamples = colorsBySample(samples);
          desc.shader = format == VITRAIL_NODE_STANDARD ? ShaderKind::ForCpu : ShaderKind::Usual;
          apply(way, desc);
          test(desc);
        }
      }
    }
  }

  static bool isPerPixelDraw(const Way& way) {
    return way.resolve == VITRAIL_RESOLVE_FRAGMENT && way.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  }

  static bool exactFilters(const HostDesc& desc) {
    return desc.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_PIXEL || features().dualSourceBlending;
  }
};

VITRAIL_ON_EVERY_BACKEND(SamplesTest);

TEST_P(SamplesTest, ListsOfEveryLengthMatchTheReference) {
  forEveryHost([](HostDesc& desc) {
    desc.width = 11;
    PointVariety variety;
    variety.coverage = true;
    variety.blendModes = exactFilters(desc);
    variety.brightest = desc.nodes == VITRAIL_NODE_HDR ? 8.0F : 1.0F;
    std::vector<std::uint32_t> lengths = {0,  1,  2,  3,  4,  5,  7,  8,  9,  12, 15, 16,  17,
                                          20, 24, 31, 32, 33, 34, 40, 48, 49, 64, 65, 100, 400};
    const std::vector<Point> points = randomLists(desc, lengths, 21, variety);
    desc.capacity = static_cast<std::uint32_t>(points.size());
    const auto host = makeHost(desc);
    const Expected expected = expectedFrame(desc, points);
    const PointResult forward = host->draw(points);
    EXPECT_LT(largestError(forward.pixels, expected.pixels), kTolerance);
    EXPECT_EQ(forward.stats.complete, 1U);
    EXPECT_EQ(forward.stats.fragmentsStored, expected.fragments);
    EXPECT_EQ(forward.stats.coveredPixels, expected.coveredPixels);
    EXPECT_EQ(forward.stats.layersMax, expected.layersMax);
    EXPECT_TRUE(host->draw(ordered(points, Order::Shuffled)).pixels == forward.pixels) << "order changes the picture";
  });
}

// Points between opaque surfaces of different depths: what a sample hides is in no list of it. Points exactly as deep
// as an opaque sample pass.
void addOpaqueDepths(HostDesc& desc) {
  for (std::uint32_t s = 0; s < desc.samples; ++s) {
    const std::uint32_t step = s * 5 % desc.samples;
    desc.opaqueDepth.push_back(0.2617F + 0.5031F * static_cast<float>(step) / static_cast<float>(desc.samples));
  }
}

std::vector<Point> pointsBetween(const HostDesc& desc) {
  PointVariety variety;
  variety.coverage = true;
  std::vector<Point> points = randomLists(desc, {1, 2, 3, 5, 16, 20, 31, 33, 70, 0, 8, 8}, 33, variety);
  for (std::size_t i = 0; i < points.size(); i += 7) points[i].depth = desc.opaqueDepth[i % desc.samples];
  // Compact codes cannot tell depths just before an opaque one from those just behind it.
  if (desc.nodes == VITRAIL_NODE_COMPACT) {
    for (Point& point : points) {
      for (const float opaque : desc.opaqueDepth) {
        if (point.depth != opaque && std::abs(point.depth - opaque) < 0x1p-8F) point.depth = opaque;
      }
    }
  }
  return points;
}

TEST_P(SamplesTest, EverySampleHasItsOwnDepthTest) {
  forEveryHost([](HostDesc& desc) {
    desc.depthOrder =
        desc.resolve == VITRAIL_RESOLVE_COMPUTE ? VITRAIL_DEPTH_NEAREST_IS_ZERO : VITRAIL_DEPTH_NEAREST_IS_ONE;
    addOpaqueDepths(desc);
    const std::vector<Point> points = pointsBetween(desc);
    desc.capacity = static_cast<std::uint32_t>(points.size());
    std::vector<std::vector<FloatColor>> pictures;
    for (const bool postDepth : {true, false}) {
      desc.postDepthCoverage = postDepth;
      const Expected expected = expectedFrame(desc, points, features().postDepthCoverage);
      const PointResult result = draw(desc, points);
      EXPECT_LT(largestError(result.pixels, expected.pixels), kTolerance) << "post-depth coverage " << postDepth;
      EXPECT_EQ(result.stats.fragmentsStored, expected.fragments) << "post-depth coverage " << postDepth;
      EXPECT_EQ(result.stats.complete, 1U);
      pictures.push_back(result.pixels);
    }
    // Equal depths of other coverage may stand in another order, and compact nodes have many of them.
    if (desc.nodes == VITRAIL_NODE_COMPACT) return;
    EXPECT_LT(largestError(pictures[1], asColors(pictures[0])), kTolerance);
  });
}

// The same at one sample, where the early depth test alone decides.
TEST_P(SamplesTest, OneSampleIsHiddenByTheHostsDepthTest) {
  for (const Way& way : everyWay(features(), 1)) {
    SCOPED_TRACE(way.name);
    HostDesc desc;
    apply(way, desc);
    desc.opaqueDepth = {0.5F};
    std::vector<Point> points = randomLists(desc, {3, 17, 40}, 2);
    points[0].depth = 0.5F;
    desc.capacity = static_cast<std::uint32_t>(points.size());
    const PointResult result = draw(desc, points);
    const Expected expected = expectedFrame(desc, points);
    EXPECT_LT(expected.fragments, points.size());
    EXPECT_EQ(result.stats.fragmentsStored, expected.fragments);
    EXPECT_LT(largestError(result.pixels, expected.pixels), kTolerance);
  }
}

// Per-pixel resolves equal per-sample ones followed by a box filter.
TEST_P(SamplesTest, EveryWayGivesOnePicture) {
  for (const std::uint32_t samples : features().multisampled) {
    std::vector<Color> first;
    for (const Way& way : everyWay(features(), samples)) {
      SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name);
      HostDesc desc;
      desc.samples = samples;
      desc.behindSamples = colorsBySample(samples);
      apply(way, desc);
      PointVariety variety;
      variety.coverage = true;
      const std::vector<Point> points = randomLists(desc, {0, 1, 4, 16, 17, 32, 33, 90}, 5, variety);
      desc.capacity = static_cast<std::uint32_t>(points.size());
      const PointResult result = draw(desc, points);
      if (first.empty()) first = asColors(result.pixels);
      EXPECT_LT(largestError(result.pixels, first), 1e-6);
    }
  }
}

// Every pixel is the mean of its opaque samples, whether or not it has fragments.
TEST_P(SamplesTest, PixelsWithoutFragmentsAreFiltered) {
  for (const std::uint32_t samples : features().multisampled) {
    for (const Way& way : everyWay(features(), samples)) {
      SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name);
      HostDesc desc;
      desc.samples = samples;
      desc.behindSamples = colorsBySample(samples);
      desc.capacity = 1;
      apply(way, desc);
      const PointResult result = draw(desc, {});
      EXPECT_LT(largestError(result.pixels, expectedFrame(desc, {}).pixels), 1e-6);
      EXPECT_EQ(result.stats.coveredPixels, 0U);
    }
  }
}

// A target that takes coverage to have passed the depth test stores none that has not; the other way round it tests
// again.
TEST_P(SamplesTest, CoverageThatWasNotTestedIsNotTakenForTested) {
  if (!features().postDepthCoverage) GTEST_SKIP() << "the device has no post-depth coverage";
  for (const std::uint32_t samples : sampleCounts(features())) {
    if (samples == 1) continue;
    HostDesc desc;
    desc.samples = samples;
    const std::vector<Point> points = randomLists(desc, {3, 1}, 5);
    desc.capacity = static_cast<std::uint32_t>(points.size());
    const PointResult right = draw(desc, points);
    desc.shaderPostDepth = false;
    const PointResult wrong = draw(desc, points);
    EXPECT_EQ(wrong.stats.complete, 0U);
    EXPECT_EQ(wrong.stats.fragmentsStored, 0U);
    EXPECT_EQ(wrong.stats.fragmentsMissing, right.stats.fragmentsStored);
    desc.postDepthCoverage = false;
    desc.shaderPostDepth = true;
    EXPECT_TRUE(draw(desc, points).pixels == right.pixels);
  }
}

TEST_P(SamplesTest, AFragmentWithoutCoverageIsNotStored) {
  for (const std::uint32_t samples : features().multisampled) {
    HostDesc desc;
    desc.samples = samples;
    desc.capacity = 2;
    const std::vector<Point> points = {{0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}, VITRAIL_BLEND_OVER, 0},
                                       {1, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}, VITRAIL_BLEND_OVER, 1}};
    EXPECT_EQ(draw(desc, points).stats.fragmentsRequested, 1U);
  }
}

} // namespace
} // namespace vitrail::tests
