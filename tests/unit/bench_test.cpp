// The arithmetic of `vitrail bench`: statistics, the bytes of a frame, the matrix of settings, ratios and the table,
// each against values worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "bench/matrix.h"
#include "bench/measurement.h"
#include "bench/short_count.h"
#include "bench/statistics.h"
#include "bench/traffic.h"
#include "methods/methods.h"
#include "report/bench_csv.h"
#include "report/bench_json.h"
#include "report/bench_table.h"
#include "report/cells.h"

namespace vitrail::tests {
namespace {

using namespace vitrail::tool;

// linked-list with nodes of 12 bytes.
MethodOptions listOptions() {
  MethodOptions options;
  options.nodes = VITRAIL_NODE_STANDARD;
  return options;
}

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

TEST(Traffic, BytesOfARasterByHand) {
  FrameShape frame;
  frame.pixels = 1000;
  frame.coveredPixels = 100;
  const RasterCounts counts{.triangles = 50, .vertices = 30, .records = 70};
  // Vertices: 44 * 30. Triangles: 12 * 50. Records: 64 * 70. Colour: 16 * 100. Depth: 4 * 100.
  EXPECT_EQ(leastRasterBytes(frame, counts), 1320U + 600U + 4480U + 1600U + 400U);
  frame.samples = 4; // Records: 64 more. Colour: as of lists. Depth: of 4 samples.
  EXPECT_EQ(leastRasterBytes(frame, counts), 1320U + 600U + 8960U + 40000U + 1600U);
}

std::vector<std::string> describeAll(const BenchMatrix& matrix) {
  std::vector<std::string> texts;
  for (const MethodOptions& options : configurationsOf(matrix).measured) texts.push_back(describe(options));
  return texts;
}

TEST(BenchMatrix, EveryChoiceWithEveryOther) {
  BenchMatrix matrix;
  matrix.nodes = {VITRAIL_NODE_STANDARD};
  matrix.methods = {"linked-list"};
  matrix.nodes = {VITRAIL_NODE_COMPACT, VITRAIL_NODE_HDR};
  matrix.resolves = {VITRAIL_RESOLVE_COMPUTE, VITRAIL_RESOLVE_FRAGMENT};
  EXPECT_EQ(describeAll(matrix),
            (std::vector<std::string>{"unsorted", "linked-list, compact, compute", "linked-list, compact, fragment",
                                      "linked-list, hdr, compute", "linked-list, hdr, fragment"}));
}

TEST(BenchMatrix, ListBuildsAreOfTheMethodsThatHaveThem) {
  BenchMatrix matrix;
  matrix.nodes = {VITRAIL_NODE_STANDARD};
  matrix.methods = {"linked-list", "insertion"};
  matrix.listBuilds = {VITRAIL_LIST_BUILD_FRAGMENT, VITRAIL_LIST_BUILD_COMPUTE};
  EXPECT_EQ(describeAll(matrix), (std::vector<std::string>{"unsorted", "linked-list, standard, list build fragment",
                                                           "linked-list, standard, list build compute", "insertion"}));
}

TEST(BenchMatrix, WhatAMethodDoesNotHaveIsSkippedWithAReason) {
  BenchMatrix matrix;
  matrix.nodes = {VITRAIL_NODE_STANDARD};
  matrix.methods = {"insertion", "unsorted", "linked-list"};
  matrix.nodes = {VITRAIL_NODE_COMPACT, VITRAIL_NODE_STANDARD};
  matrix.samples = {1, 8, 1};
  matrix.resolves = {VITRAIL_RESOLVE_DEFAULT};
  EXPECT_EQ(describeAll(matrix),
            (std::vector<std::string>{"unsorted", "insertion", "linked-list, compact", "linked-list, standard",
                                      "unsorted, 8 samples", "linked-list, standard, 8 samples"}));
  std::vector<std::string> skipped;
  for (const SkippedSetting& each : configurationsOf(matrix).skipped) {
    skipped.push_back(describe(each.options));
    EXPECT_NE(each.reason.find("sample"), std::string::npos) << each.reason;
  }
  EXPECT_EQ(skipped, (std::vector<std::string>{"insertion, 8 samples", "linked-list, compact, 8 samples"}));
}

TEST(BenchMatrix, MemoryAndResolvesOfSamplesAreOfTheMethodsThatHaveThem) {
  BenchMatrix matrix;
  matrix.methods = {"linked-list", "cpu", "weighted"};
  matrix.memoryBudgets = {1, 64};
  EXPECT_EQ(describeAll(matrix),
            (std::vector<std::string>{"unsorted", "linked-list, hdr, in 1 MiB", "linked-list, hdr, in 64 MiB",
                                      "cpu, in 1 MiB", "cpu, in 64 MiB", "weighted"}));
  matrix.memoryBudgets = {0};
  matrix.nodeCapacities = {1000};
  EXPECT_EQ(describeAll(matrix),
            (std::vector<std::string>{"unsorted", "linked-list, hdr, 1000 nodes at most", "cpu", "weighted"}));
  matrix.nodeCapacities = {0};
  matrix.methods = {"linked-list"};
  matrix.samples = {1, 4};
  matrix.msaaResolves = {VITRAIL_MSAA_RESOLVE_PER_PIXEL, VITRAIL_MSAA_RESOLVE_PER_SAMPLE};
  matrix.stencilMarks = {StencilMark::On, StencilMark::Off};
  EXPECT_EQ(describeAll(matrix),
            (std::vector<std::string>{"unsorted", "linked-list, hdr", "linked-list, hdr, stencil mark off",
                                      "unsorted, 4 samples", "linked-list, hdr, 4 samples",
                                      "linked-list, hdr, 4 samples, per-sample",
                                      "linked-list, hdr, 4 samples, per-sample, stencil mark off"}));
  EXPECT_EQ(configurationsOf(matrix).skipped.size(), 3U); // per sample of one, twice; no mark of a per-pixel resolve
  matrix.resolves = {VITRAIL_RESOLVE_COMPUTE};
  matrix.samples = {1};
  EXPECT_EQ(describeAll(matrix), (std::vector<std::string>{"unsorted", "linked-list, hdr, compute"}));
}

TEST(BenchMatrix, SeveralLayersAreCompared) {
  BenchMatrix matrix;
  matrix.methods = {"linked-list", "weighted", "loop"};
  matrix.layers = {8, 32};
  EXPECT_EQ(describeAll(matrix),
            (std::vector<std::string>{"unsorted", "linked-list, hdr, 8 layers", "linked-list, hdr, 32 layers",
                                      "weighted", "loop, 8 layers", "loop, 32 layers"}));
}

std::string refusalOf(const std::vector<std::string>& methods, const MethodLimits& limits) {
  try {
    checkLimits(methods, limits);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(BenchMatrix, LimitsAreOfTheMethodsThatHaveThem) {
  BenchMatrix matrix;
  matrix.nodes = {VITRAIL_NODE_STANDARD};
  matrix.methods = {"linked-list", "weighted", "loop", "stochastic"};
  matrix.resolves = {VITRAIL_RESOLVE_FRAGMENT};
  matrix.limits = {16, 1};
  EXPECT_EQ(describeAll(matrix), (std::vector<std::string>{"unsorted", "linked-list, standard, fragment, 16 layers",
                                                           "weighted", "loop, 16 layers", "stochastic, 1 pass"}));
  EXPECT_EQ(describe(matrix.limits), "Of the methods that have the option: --layers 16 --passes 1\n");
  EXPECT_EQ(describe(MethodLimits{}), "");
  EXPECT_EQ(refusalOf({}, matrix.limits), ""); // all methods
  EXPECT_EQ(refusalOf({"weighted"}, {}), "");
  EXPECT_EQ(refusalOf({"unsorted", "loop"}, {16, 0}), "");
  EXPECT_EQ(refusalOf({"weighted", "sorted"}, {16, 0}).find("--layers is of the method linked-list, "), 0U);
  EXPECT_EQ(refusalOf({"loop"}, {16, 4}), "--passes is of the method stochastic: loop has no choice, leave it out");
}

TEST(BenchMatrix, WithoutAChoiceThereIsEveryMethodOnce) {
  const BenchSettings settings = configurationsOf(BenchMatrix{});
  EXPECT_TRUE(settings.skipped.empty());
  std::vector<std::string_view> names;
  for (const MethodOptions& options : settings.measured) names.push_back(options.name);
  EXPECT_EQ(names.front(), kBaselineMethod);
  EXPECT_EQ(names.size(), methodNames().size());
  for (const std::string_view name : methodNames()) EXPECT_EQ(std::ranges::count(names, name), 1) << name;
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
  lists.complete = true;
  lists.nodes = "standard";
  lists.resolve = "compute";
  lists.listBuild = "fragment";
  lists.fragmentsRequested = lists.fragmentsStored = 700;
  lists.layersMax = 9;
  lists.layersMean = 7.0;
  return {summarize(unsorted, plain, {{{"opaque", 1.0}, {"blend", 2.0}}, {{"opaque", 3.0}, {"blend", 2.0}}}),
          summarize(listOptions(), lists, {listFrame(1.0), listFrame(3.0), listFrame(2.0)})};
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

TEST(Measurement, CostIsThatOfFramesWithoutTimedSteps) {
  const std::vector<PassTimes> wholes = {{{"opaque", 1.0}, {"resolve", 5.0}}, {{"opaque", 1.0}, {"resolve", 6.0}}};
  const Measurement measured = summarize(listOptions(), {}, {listFrame(1.0), listFrame(3.0)}, wholes);
  EXPECT_DOUBLE_EQ(measured.costMs.median, 5.5);
  EXPECT_DOUBLE_EQ(measured.frameMs.median, 6.5);
  ASSERT_EQ(measured.passes.size(), 4U);
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

// A method that counts fragments and keeps them elsewhere than in lists: the bytes of lists say nothing of it.
TEST(Measurement, OnlyMethodsWithListsHaveAFloor) {
  std::vector<Measurement> both = twoMeasurements();
  both[1].options.name = "sorted";
  compare(both, 28e6);
  EXPECT_DOUBLE_EQ(both[1].fragmentsPerSecond.value(), 100'000.0);
  EXPECT_FALSE(both[1].floorBytes || both[1].floorMs || both[1].bandwidthShare);
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

TEST(Cells, NumbersInFewCharacters) {
  EXPECT_EQ(shortCount(999), "999");
  EXPECT_EQ(shortCount(9'949), "9.9 k");
  EXPECT_EQ(shortCount(9'950), "10 k");
  EXPECT_EQ(shortCount(999'499), "999 k");
  EXPECT_EQ(shortCount(999'500), "1.0 M");
  EXPECT_EQ(milliseconds(999.9994), "999.999");
  EXPECT_EQ(milliseconds(1000.04), "1000.0");
  EXPECT_EQ(ratio(1.084), "1.08");
  EXPECT_EQ(ratio(std::nan("")), "-");
  EXPECT_EQ(mebibytes(std::uint64_t{3} << 19U), "1.5 MiB");
}

BenchReport smallReport() {
  BenchReport report;
  report.device = "Abacus";
  report.driver = "beads 1.0";
  report.api = "Vulkan 1.3";
  report.repeats = 3;
  report.warmups = 1;
  report.bytesPerSecond = 28e6;
  SceneMeasurement scene;
  scene.name = "spheres";
  scene.count = 400;
  scene.width = 100;
  scene.height = 10;
  scene.triangles = 1'600'000;
  scene.measurements = twoMeasurements();
  compare(scene.measurements, report.bytesPerSecond);
  MethodOptions refused = listOptions();
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
  slow.floorMs = 99999.94;
  slow.report.totalBytes = std::uint64_t{99'999} << 20U;
  slow.report.resolve = "fragment";
  Measurement other = slow; // the longest name, and many passes
  other.options = listOptions();
  other.options.name = *std::ranges::max_element(methodNames(), {}, &std::string_view::size);
  other.report.nodes.clear();
  other.report.resolve.clear();
  for (const char* pass : {"count", "absorbance", "composite", "stochastic"}) other.passes.emplace_back(pass, Spread{});
  report.scenes[0].measurements.push_back(other);
  const std::string table = toTable(report);
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120U) << line;
  EXPECT_NE(table.find(" linked-list, standard, fragment   1 "), std::string::npos) << table;
  EXPECT_NE(table.find(" reverse-depth-peeling "), std::string::npos) << table;
}

BenchReport sweepReport() {
  BenchReport report = smallReport();
  report.scenes[0].skipped.clear();
  const SceneMeasurement first = report.scenes[0];
  report.scenes.clear();
  for (const SweepStep& step : planSweep(SweepKind::Resolution, {})) {
    report.scenes.push_back(first);
    report.scenes.back().sweep = placeOf(SweepKind::Resolution, step, 0);
  }
  report.scenes[1].measurements.pop_back();
  report.scenes[1].skipped = {{listOptions(), "no room"}};
  return report;
}

TEST(BenchTable, ASweepIsAGridOfMethodsAndSteps) {
  const std::string table = toTable(sweepReport());
  std::istringstream lines(table);
  std::string ratios;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 120U) << line;
    if (ratios.empty() && line.starts_with(" linked-list")) ratios = line;
  }
  std::istringstream words(ratios);
  const std::vector<std::string> cells{std::istream_iterator<std::string>(words), {}};
  EXPECT_EQ(cells, (std::vector<std::string>{"linked-list,", "standard", "3.50", "-", "3.50", "3.50", "3.50"}));
  BenchReport limited = sweepReport(); // the longest names
  limited.limits.layers = 128;
  for (SceneMeasurement& step : limited.scenes) {
    for (Measurement& measured : step.measurements) {
      measured.options.resolve = VITRAIL_RESOLVE_FRAGMENT;
      measured.options = withLimits(measured.options, limited.limits);
    }
  }
  const std::string named = toTable(limited);
  EXPECT_NE(named.find(" linked-list, standard, fragment, 128 layers      3.50         -"), std::string::npos) << named;
  EXPECT_NE(named.find("\nOf the methods that have the option: --layers 128\n"), std::string::npos) << named;
  for (const char* text : {"320x180", "3840x2160", "cost, ms", "skipped at 640x360 linked-list, standard: no room"}) {
    EXPECT_NE(table.find(text), std::string::npos) << text << " in\n" << table;
  }
  BenchReport onCpu = sweepReport();
  onCpu.isCpu = true;
  EXPECT_EQ(toTable(onCpu).find("cost, ms"), std::string::npos);
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  return all;
}

TEST(BenchCsv, OneRowForEachMeasurement) {
  BenchReport report = smallReport();
  report.device = "Abacus, \"large\"";
  report.scenes[0].measurements[1].options.maxLayers = 16;
  const std::vector<std::string> lines = linesOf(toCsv(report));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(
      lines[0],
      "device,driver,cpu,sweep,step,scene,count,width,height,triangles,method,nodes,resolve,samples,exact,"
      "fragments,missing,layers_max,tiles,cost_ms,cost_lower_quartile_ms,cost_upper_quartile_ms,frame_ms,"
      "cost_ratio,frame_ratio,memory_bytes,max_layers,passes,list_build,msaa_resolve,stencil_mark,memory_budget_mib,"
      "node_capacity,overflowed,approximate_pixels,api");
  EXPECT_EQ(lines[1],
            "\"Abacus, \"\"large\"\"\",beads 1.0,false,,,spheres,400,100,10,1600000,unsorted,,,1,false,,,,1,2,"
            "2,2,4,1,1,0,,,,,,,,false,,vulkan");
  EXPECT_EQ(lines[2],
            "\"Abacus, \"\"large\"\"\",beads 1.0,false,,,spheres,400,100,10,1600000,linked-list,standard,"
            "compute,1,true,700,0,9,1,7,5.25,8.75,9,3.5,2.25,0,16,,fragment,,,,,false,0,vulkan");
}

TEST(BenchCsv, ASweepNamesItsStep) {
  BenchReport report = sweepReport();
  report.scenes[0].measurements[0].costRatio = std::nan("");
  const std::vector<std::string> lines = linesOf(toCsv(report));
  ASSERT_EQ(lines.size(), 10U); // 5 steps of 2, less one
  EXPECT_NE(lines[1].find(",resolution,57600,spheres,"), std::string::npos) << lines[1];
  EXPECT_TRUE(lines[1].ends_with(",4,,1,0,,,,,,,,false,,vulkan")) << lines[1]; // no ratio
}

// Whoever reads one of the reports learns that a frame had more fragments than nodes.
TEST(BenchTable, AnOverflowIsSaid) {
  BenchReport report = smallReport();
  Measurement& measured = report.scenes[0].measurements[1];
  measured.options.nodeCapacity = 500;
  EXPECT_EQ(toTable(report).find("overflowed"), std::string::npos); // they were enough
  measured.report.complete = false;
  measured.report.fragmentsMissing = 200;
  EXPECT_NE(toTable(report).find(" not exact: linked-list, standard, 500 nodes at most overflowed: 200 of 700"),
            std::string::npos)
      << toTable(report);
  EXPECT_TRUE(linesOf(toCsv(report))[2].ends_with(",500,true,0,vulkan")) << toCsv(report);
  EXPECT_NE(toJson(report).find("\"overflowed\": true"), std::string::npos);
}

// Tiles do not hide that a frame is not exact.
TEST(BenchTable, ACapIsSaidInTiles) {
  BenchReport report = smallReport();
  Measurement& measured = report.scenes[0].measurements[1];
  measured.options.memoryBudget = 2;
  measured.options.maxLayers = 8;
  measured.report.complete = false;
  measured.report.tiles = 3;
  const std::string table = toTable(report);
  EXPECT_NE(table.find("in 2 MiB, 8 layers drew 3 tiles"), std::string::npos) << table;
  EXPECT_NE(table.find("not exact: linked-list, standard, in 2 MiB, 8 layers\n"), std::string::npos) << table;
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
  frame.complete = false;
  frame.fragmentsMissing = 12;
  const std::string other = toTable(report);
  EXPECT_NE(other.find("only the ratios"), std::string::npos);
  EXPECT_NE(other.find("not exact: linked-list, standard left out 12 of 700"), std::string::npos) << other;
  report.scenes[0].measurements[1].options.listBuild = VITRAIL_LIST_BUILD_FRAGMENT;
  EXPECT_NE(toTable(report).find("linked-list, standard, compute, list build fragment  "), std::string::npos);
  frame.tiles = 3;
  EXPECT_NE(toTable(report).find("drew 3 tiles"), std::string::npos) << toTable(report);
}

} // namespace
} // namespace vitrail::tests
