// What lies under a pixel: lists that the library copies out, and lists that a shader of the host's walks. Both are the
// stored fragments in the order that they are blended in, with the host's words, and no picture changes by it.
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "../thorough.h"
#include "expected.h"

namespace vitrail::tests {
namespace {

// A way to read.
struct Reading {
  ReadBy by = ReadBy::Copy;
  bool afterResolve = false;
};

constexpr std::array kReadings{Reading{ReadBy::Copy, false}, Reading{ReadBy::Copy, true},
                               Reading{ReadBy::Shader, false}, Reading{ReadBy::Shader, true}};

std::string describe(const Reading& reading) {
  return std::string(reading.by == ReadBy::Copy ? "copied" : "walked") +
         (reading.afterResolve ? " after the resolve" : " before the resolve");
}

class ReadingTest : public BackendTest {
 protected:
  static HostDesc hostDesc() {
    HostDesc desc;
    desc.width = 16;
    desc.height = 8;
    desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
    desc.userWords = true;
    desc.copyLayers = 2000;
    return desc;
  }

  // Lists of all classes of lengths, each fragment with a word of its own; of the same key twice in a row.
  static std::vector<Point> wordyPoints(const HostDesc& desc, unsigned seed, bool coverage = false) {
    PointVariety variety;
    variety.blendModes = true;
    variety.coverage = coverage;
    variety.brightest = desc.nodes == VITRAIL_NODE_HDR ? 8.0F : 1.0F;
    std::vector<Point> points = randomLists(desc, {0, 1, 2, 5, 16, 17, 31, 32, 33, 64, 65, 100, 127}, seed, variety);
    const std::size_t once = points.size();
    for (std::size_t i = 0; i < once; i += 9) {
      if (points[i].y == 0 && points[i].x < 12) points.push_back(points[i]);
    }
    for (std::size_t i = 0; i < points.size(); ++i) points[i].word = static_cast<std::uint32_t>(i * 2654435761U);
    return points;
  }

  static void expectLists(const ListsRead& read, const HostDesc& desc, std::span<const Point> points,
                          const VitrailRect& area) {
    const std::vector<std::vector<VitrailLayer>> expected = expectedLists(desc, points);
    ASSERT_EQ(read.pixels.size(), std::size_t{area.width} * area.height);
    for (std::size_t i = 0; i < read.pixels.size(); ++i) {
      const std::size_t x = area.x + i % area.width;
      const std::size_t y = area.y + i / area.width;
      SCOPED_TRACE("pixel " + std::to_string(x) + ", " + std::to_string(y));
      ASSERT_TRUE(read.pixels[i]) << "left out";
      expectList(*read.pixels[i], expected[y * desc.width + x]);
    }
  }

  static void expectList(const std::vector<VitrailLayer>& got, const std::vector<VitrailLayer>& expected) {
    ASSERT_EQ(got.size(), expected.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
      SCOPED_TRACE("layer " + std::to_string(i));
      for (unsigned c = 0; c < 4; ++c) {
        ASSERT_NEAR(got[i].color[c], expected[i].color[c], 1e-5F * std::max(1.0F, expected[i].color[c]));
      }
      ASSERT_EQ(got[i].depth, expected[i].depth);
      ASSERT_EQ(got[i].blend, expected[i].blend);
      ASSERT_EQ(got[i].coverage, expected[i].coverage);
      ASSERT_EQ(got[i].word, expected[i].word);
    }
  }
};
VITRAIL_ON_EVERY_BACKEND(ReadingTest);

TEST_P(ReadingTest, ListsAreWhatIsBlendedInOrder) {
  for (const VitrailNodeFormat format : nodeFormats(1)) {
    for (const Way& way : everyWay(features(), 1)) {
      if (way.resolve == VITRAIL_RESOLVE_FRAGMENT && !features().dualSourceBlending) continue;
      for (const Reading& reading : kReadings) {
        SCOPED_TRACE("format " + std::to_string(format) + ", " + way.name + ", " + describe(reading));
        HostDesc desc = hostDesc();
        desc.nodes = format;
        desc.specialized = format == VITRAIL_NODE_HDR;
        apply(way, desc);
        const std::vector<Point> points = wordyPoints(desc, 3);
        desc.capacity = static_cast<std::uint32_t>(points.size());
        const auto host = makeHost(desc);
        const VitrailRect area = {0, 0, desc.width, desc.height};
        const ListsRead read =
            host->drawAndRead(ordered(points, Order::Shuffled), area, reading.by, reading.afterResolve);
        expectLists(read, desc, points, area);
        EXPECT_EQ(read.frame.stats.complete, 1U);
        EXPECT_TRUE(read.frame.pixels == host->draw(points).pixels) << "reading changes the picture";
        EXPECT_EQ(read.layers, reading.by == ReadBy::Copy ? points.size() : 0U);
      }
    }
  }
}

TEST_P(ReadingTest, SamplesPoolsAndAreasOfAllKinds) {
  std::vector<std::uint32_t> counts = sampleCounts(features());
  if (counts.size() > 2) counts = {1, 4};
  for (const std::uint32_t samples : counts) {
    for (const bool addresses : {false, true}) {
      if (addresses && !features().addresses) continue;
      for (const bool words : {false, true}) {
        for (const ReadBy by : {ReadBy::Copy, ReadBy::Shader}) {
          SCOPED_TRACE(std::to_string(samples) + " samples" + (addresses ? ", by address, " : ", ") +
                       (words ? "words, " : "") + describe(Reading{by, true}));
          HostDesc desc = hostDesc();
          desc.samples = samples;
          desc.addresses = addresses;
          desc.userWords = words;
          const std::vector<Point> points = wordyPoints(desc, 4, samples > 1);
          desc.capacity = static_cast<std::uint32_t>(points.size());
          const VitrailRect area = {3, 0, 7, 5}; // 5 to 127 are not all in it
          const ListsRead read = makeHost(desc)->drawAndRead(points, area, by, true);
          expectLists(read, desc, points, area);
        }
      }
    }
  }
}

// Where the host resolves: long lists lie sorted, alike fragments by their words, however nodes are stored and linked,
// and the counters are as ever. No picture is drawn.
TEST_P(ReadingTest, TheHostResolvesListsThatLieSorted) {
  std::vector<std::uint32_t> counts = sampleCounts(features());
  if (counts.size() > 2) counts = {1, 4};
  for (const std::uint32_t samples : counts) {
    for (const VitrailNodeFormat format : nodeFormats(samples)) {
      for (const VitrailListBuild build : {VITRAIL_LIST_BUILD_FRAGMENT, VITRAIL_LIST_BUILD_COMPUTE}) {
        for (const bool addresses : {false, true}) {
          if (addresses && !features().addresses) continue;
          const bool isUsual = build == VITRAIL_LIST_BUILD_COMPUTE && !addresses;
          if (format != VITRAIL_NODE_STANDARD && !isUsual && !isThorough()) continue;
          SCOPED_TRACE(std::to_string(samples) + " samples, format " + std::to_string(format) + ", build " +
                       std::to_string(build) + (addresses ? ", by address" : ""));
          HostDesc desc = hostDesc();
          desc.samples = samples;
          desc.nodes = format;
          desc.listBuild = build;
          desc.addresses = addresses;
          desc.resolve = VITRAIL_RESOLVE_HOST;
          const std::vector<Point> points = wordyPoints(desc, 8, samples > 1);
          desc.capacity = static_cast<std::uint32_t>(points.size());
          const VitrailRect area = {0, 0, desc.width, desc.height};
          for (const bool afterResolve : {false, true}) {
            const ListsRead read =
                makeHost(desc)->drawAndRead(ordered(points, Order::Shuffled), area, ReadBy::Shader, afterResolve);
            expectLists(read, desc, points, area);
            EXPECT_EQ(read.frame.stats.complete, 1U);
            EXPECT_EQ(read.frame.stats.layersMax, expectedFrame(desc, points).layersMax);
            EXPECT_EQ(read.frame.stats.coveredPixels, expectedFrame(desc, points).coveredPixels);
          }
        }
      }
    }
  }
}

// A copy of lists that lie sorted, and a frame that overflows: its lists are walked, and end.
TEST_P(ReadingTest, TheHostMayCopyAndOverflow) {
  HostDesc desc = hostDesc();
  desc.resolve = VITRAIL_RESOLVE_HOST;
  const std::vector<Point> points = wordyPoints(desc, 9);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const VitrailRect area = {0, 0, desc.width, desc.height};
  expectLists(makeHost(desc)->drawAndRead(points, area, ReadBy::Copy, false), desc, points, area);
  desc.capacity /= 2;
  const ListsRead read = makeHost(desc)->drawAndRead(points, area, ReadBy::Shader, false);
  EXPECT_EQ(read.frame.stats.complete, 0U);
  EXPECT_GT(read.frame.stats.fragmentsMissing, 0U);
  std::size_t layers = 0;
  for (const auto& list : read.pixels) layers += list ? list->size() : 0;
  EXPECT_EQ(layers, desc.capacity);
}

// Words are no part of what is drawn.
TEST_P(ReadingTest, WordsChangeNoPicture) {
  for (const Way& way : everyWay(features(), 1)) {
    SCOPED_TRACE(way.name);
    HostDesc desc = hostDesc();
    apply(way, desc);
    const std::vector<Point> points = wordyPoints(desc, 7);
    desc.capacity = static_cast<std::uint32_t>(points.size());
    const PointResult with = draw(desc, points);
    desc.userWords = false;
    desc.copyLayers = 0;
    EXPECT_TRUE(draw(desc, points).pixels == with.pixels);
  }
}

// Lists that find no room are left out whole, and the header says how much room they would take.
TEST_P(ReadingTest, ListsThatFindNoRoomAreLeftOut) {
  HostDesc desc = hostDesc();
  const std::vector<Point> points = wordyPoints(desc, 5);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  desc.copyLayers = 200;
  const VitrailRect area = {0, 0, desc.width, desc.height};
  const ListsRead read = makeHost(desc)->drawAndRead(points, area, ReadBy::Copy, false);
  EXPECT_EQ(read.layers, points.size());
  const std::vector<std::vector<VitrailLayer>> expected = expectedLists(desc, points);
  std::size_t leftOut = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (read.pixels[i]) {
      expectList(*read.pixels[i], expected[i]);
    } else {
      ++leftOut;
    }
  }
  EXPECT_GT(leftOut, 0U);
  EXPECT_LT(leftOut, 12U); // some found room
}

TEST_P(ReadingTest, ListsOfFramesThatOverflowAreLeftOut) {
  HostDesc desc = hostDesc();
  const std::vector<Point> points = wordyPoints(desc, 6);
  desc.capacity = static_cast<std::uint32_t>(points.size() / 2);
  const VitrailRect area = {0, 0, desc.width, desc.height};
  const ListsRead read = makeHost(desc)->drawAndRead(points, area, ReadBy::Copy, true);
  EXPECT_EQ(read.frame.stats.complete, 0U);
  for (const auto& list : read.pixels) EXPECT_TRUE(!list || list->empty());
}

} // namespace
} // namespace vitrail::tests
