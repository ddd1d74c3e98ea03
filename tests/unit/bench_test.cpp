// The arithmetic of `vitrail bench`: statistics, the bytes of a frame, the matrix of settings, ratios and the table,
// each against values worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "bench/matrix.h"
#include "bench/measurement.h"
#include "bench/statistics.h"
#include "bench/table.h"
#include "bench/traffic.h"

namespace vitrail::tests {
namespace {

using namespace vitrail::tool;

TEST(Statistics, MedianAndQuartilesByHand) {
  const Spread odd = spreadOf({5.0, 1.0, 3.0, 2.0, 4.0});
  EXPECT_DOUBLE_EQ(odd.median, 3.0);
  EXPECT_DOUBLE_EQ(odd.lowerQuartile, 2.0);
  EXPECT_DOUBLE_EQ(odd.upperQuartile, 4.0);
  EXPECT_DOUBLE_EQ(odd.min, 1.0);
  EXPECT_DOUBLE_EQ(odd.max, 5.0);
  // Places 0.75, 1.5 and 2.25 of 0 to 3.
  const Spread even = spreadOf({40.0, 10.0, 20.0, 30.0});
  EXPECT_DOUBLE_EQ(even.lowerQuartile, 17.5);
  EXPECT_DOUBLE_EQ(even.median, 25.0);
  EXPECT_DOUBLE_EQ(even.upperQuartile, 32.5);
  EXPECT_DOUBLE_EQ(relativeRange(even), 0.6);
}

TEST(Statistics, OneOutlierMovesNeitherMedianNorQuartiles) {
  const Spread spread = spreadOf({1.0, 2.0, 3.0, 4.0, 1e9});
  EXPECT_DOUBLE_EQ(spread.median, 3.0);
  EXPECT_DOUBLE_EQ(spread.upperQuartile, 4.0);
  EXPECT_DOUBLE_EQ(spread.max, 1e9);
}

TEST(Statistics, FewMeasurements) {
  const Spread one = spreadOf({7.0});
  for (const double value : {one.median, one.lowerQuartile, one.upperQuartile, one.min, one.max}) {
    EXPECT_DOUBLE_EQ(value, 7.0);
  }
  EXPECT_DOUBLE_EQ(spreadOf({2.0, 1.0}).median, 1.5);
  EXPECT_THROW(spreadOf({}), std::invalid_argument);
}

TEST(Statistics, Ratios) {
  EXPECT_DOUBLE_EQ(ratioOfMedians(spreadOf({2.0, 3.0, 9.0}), spreadOf({1.0, 2.0, 2.5})), 1.5);
  EXPECT_TRUE(std::isnan(ratioOfMedians(spreadOf({1.0}), spreadOf({0.0}))));
  EXPECT_TRUE(std::isnan(relativeRange(spreadOf({0.0}))));
}

TEST(Traffic, BytesByHand) {
  FrameShape frame;
  frame.pixels = 1000;
  frame.coveredPixels = 100;
  frame.fragments = 700;
  frame.nodeBytes = 12;
  // Heads: 8 * 1000 + 8 * 100. Nodes: 24 * 700. Colour: 16 * 100.
  EXPECT_EQ(leastBytes(frame), 8000U + 800U + 16800U + 1600U);
  frame.samples = 4; // Colour: 4 samples read and one pixel written, 8 bytes each, everywhere.
  EXPECT_EQ(leastBytes(frame), 8000U + 800U + 16800U + 40000U);
}

// Words, for comparison.
std::vector<std::string> describeAll(const BenchMatrix& matrix) {
  std::vector<std::string> texts;
  for (const MethodOptions& options : configurationsOf(matrix)) texts.push_back(describe(options));
  return texts;
}

TEST(BenchMatrix, EveryChoiceWithEveryOther) {
  BenchMatrix matrix;
  matrix.methods = {"linked-list"};
  matrix.nodes = {VITRAIL_NODE_COMPACT, VITRAIL_NODE_HDR};
  matrix.resolves = {VITRAIL_RESOLVE_COMPUTE, VITRAIL_RESOLVE_FRAGMENT};
  EXPECT_EQ(describeAll(matrix),
            (std::vector<std::string>{"unsorted", "linked-list, compact, compute", "linked-list, compact, fragment",
                                      "linked-list, hdr, compute", "linked-list, hdr, fragment"}));
}

TEST(BenchMatrix, WhatAMethodDoesNotHaveIsLeftOut) {
  BenchMatrix matrix;
  matrix.methods = {"insertion", "unsorted", "linked-list"};
  matrix.nodes = {VITRAIL_NODE_COMPACT, VITRAIL_NODE_STANDARD};
  matrix.samples = {1, 8, 1};
  matrix.resolves = {VITRAIL_RESOLVE_DEFAULT};
  EXPECT_EQ(describeAll(matrix),
            (std::vector<std::string>{"unsorted", "insertion", "linked-list, compact", "linked-list, standard",
                                      "unsorted, 8 samples", "linked-list, standard, 8 samples"}));
}

// A frame of a method with lists: 0.5 + 2 + 1 ms after 1 ms of opaque surfaces, each times `factor`.
PassTimes listFrame(double factor) {
  return {{"opaque", factor}, {"clear", 0.5 * factor}, {"collect", 2.0 * factor}, {"resolve", factor}};
}

std::vector<Measurement> twoMeasurements() {
  MethodOptions unsorted;
  unsorted.name = "unsorted";
  FrameReport plain;
  plain.width = 100;
  plain.height = 10;
  FrameReport lists = plain;
  lists.counted = true;
  lists.exact = true;
  lists.nodes = "standard";
  lists.resolve = "compute";
  lists.fragmentsRequested = lists.fragmentsStored = 700;
  lists.layersMax = 9;
  lists.layersMean = 7.0;
  return {summarize(unsorted, plain, {{{"opaque", 1.0}, {"blend", 2.0}}, {{"opaque", 3.0}, {"blend", 2.0}}}),
          summarize(MethodOptions{}, lists, {listFrame(1.0), listFrame(3.0), listFrame(2.0)})};
}

TEST(Measurement, CostIsAllButTheOpaquePass) {
  const Measurement measured = twoMeasurements()[1];
  EXPECT_DOUBLE_EQ(measured.costMs.median, 7.0);
  EXPECT_DOUBLE_EQ(measured.costMs.min, 3.5);
  EXPECT_DOUBLE_EQ(measured.costMs.upperQuartile, 8.75);
  EXPECT_DOUBLE_EQ(measured.frameMs.median, 9.0);
  ASSERT_EQ(measured.passes.size(), 4U);
  EXPECT_EQ(measured.passes[2].first, "collect");
  EXPECT_DOUBLE_EQ(measured.passes[2].second.median, 4.0);
}

TEST(Measurement, RatiosRatesAndFloorsByHand) {
  std::vector<Measurement> both = twoMeasurements();
  compare(both, 28e6);
  EXPECT_DOUBLE_EQ(both[0].costRatio, 1.0);
  EXPECT_DOUBLE_EQ(both[1].costRatio, 3.5);   // 7 over 2
  EXPECT_DOUBLE_EQ(both[1].frameRatio, 2.25); // 9 over 4
  // The baseline has the fragments of the method that counts them.
  EXPECT_DOUBLE_EQ(both[0].fragmentsPerSecond.value(), 350'000.0);
  EXPECT_DOUBLE_EQ(both[1].fragmentsPerSecond.value(), 100'000.0);
  EXPECT_FALSE(both[0].floorBytes || both[0].floorMs || both[0].bandwidthShare);
  // 1000 pixels, 100 of them covered: 8000 + 800 + 24 * 700 + 1600 bytes.
  EXPECT_EQ(both[1].floorBytes.value(), 27200U);
  EXPECT_NEAR(both[1].floorMs.value(), 27200.0 / 28e3, 1e-12);
  EXPECT_NEAR(both[1].bandwidthShare.value(), 27200.0 / 28e3 / 7.0, 1e-12);
}

TEST(Measurement, EachSampleCountHasItsOwnBaseline) {
  std::vector<Measurement> all = twoMeasurements();
  std::vector<Measurement> slower = twoMeasurements();
  for (Measurement& measured : slower) measured.options.samples = measured.report.samples = 4;
  slower[0].costMs = spreadOf({14.0});
  all.insert(all.end(), slower.begin(), slower.end());
  compare(all, 1e9);
  EXPECT_DOUBLE_EQ(all[1].costRatio, 3.5);
  EXPECT_DOUBLE_EQ(all[3].costRatio, 0.5);
}

TEST(Measurement, ABaselineThatTookNoTimeGivesNoRatio) {
  std::vector<Measurement> both = twoMeasurements();
  both[0].costMs = spreadOf({0.0});
  compare(both, 1e9);
  EXPECT_TRUE(std::isnan(both[1].costRatio));
  EXPECT_FALSE(both[0].fragmentsPerSecond.has_value());
}

BenchReport smallReport() {
  BenchReport report;
  report.device = "Abacus";
  report.driver = "beads 1.0";
  report.api = "Vulkan 1.3";
  report.width = 100;
  report.height = 10;
  report.repeats = 3;
  report.warmups = 1;
  report.bytesPerSecond = 28e6;
  SceneMeasurement scene;
  scene.name = "spheres";
  scene.count = 400;
  scene.triangles = 1'600'000;
  scene.measurements = twoMeasurements();
  compare(scene.measurements, report.bytesPerSecond);
  MethodOptions refused;
  refused.samples = 8;
  scene.skipped = {{refused, "it has no 8 samples"}};
  report.scenes = {scene};
  return report;
}

TEST(BenchTable, HoldsWhatWasMeasuredIn120Columns) {
  BenchReport report = smallReport();
  Measurement& slow = report.scenes[0].measurements[1]; // the widest numbers that fit
  for (auto& [name, spread] : slow.passes) spread.median = 99999.94;
  slow.costMs.median = slow.frameMs.median = 99999.94;
  slow.costRatio = slow.frameRatio = 999.994;
  slow.fragmentsPerSecond = 99'999'999e6;
  const std::string table = toTable(report);
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120U) << line;
}

TEST(BenchTable, SaysWhatItIs) {
  BenchReport report = smallReport();
  const std::string table = toTable(report);
  for (const char* text :
       {"Abacus", "beads 1.0", "100x10", "spheres --count 400", "1.6 M triangles", "unsorted", "linked-list", "3.50",
        "2.25", "7.000", "skipped linked-list, standard, 8 samples: it has no"}) {
    EXPECT_NE(table.find(text), std::string::npos) << text << " in\n" << table;
  }
  EXPECT_EQ(table.find("CPU"), std::string::npos);
  EXPECT_EQ(table.find("not exact"), std::string::npos);
  report.isCpu = true;
  FrameReport& frame = report.scenes[0].measurements[1].report;
  frame.exact = false;
  frame.fragmentsMissing = 12;
  const std::string other = toTable(report);
  EXPECT_NE(other.find("only the ratios"), std::string::npos);
  EXPECT_NE(other.find("not exact: linked-list, standard left out 12 of 700"), std::string::npos) << other;
  frame.tiles = 3;
  EXPECT_NE(toTable(report).find("drew 3 tiles"), std::string::npos) << toTable(report);
}

} // namespace
} // namespace vitrail::tests
