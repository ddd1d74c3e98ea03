// The advice of `vitrail bench`, against measurements that are made up.
#include <gtest/gtest.h>

#include "report/recommendation.h"

namespace vitrail::tests {
namespace {

using namespace vitrail::tool;

constexpr std::uint64_t kMib = std::uint64_t{1} << 20U;

// A method that costs `ms`, within a tenth, and keeps `mib`. The baseline costs 2 ms.
Measurement measuredAs(const std::string& method, double ms, std::uint64_t mib, bool exact) {
  Measurement measured;
  measured.options.name = method;
  measured.options.nodes = VITRAIL_NODE_STANDARD;
  measured.report.complete = exact;
  measured.report.totalBytes = mib * kMib;
  measured.costMs = {ms, 0.95 * ms, 1.05 * ms, 0.9 * ms, 1.1 * ms};
  measured.costRatio = ms / 2.0;
  return measured;
}

SceneMeasurement layersOf(std::uint32_t layers, std::vector<Measurement> measurements) {
  SceneMeasurement scene;
  scene.name = "planes";
  SweepStep step;
  step.panes = layers;
  scene.sweep = placeOf(SweepKind::Layers, step, 0);
  scene.measurements = std::move(measurements);
  return scene;
}

BenchReport reportOf(std::vector<SceneMeasurement> scenes) {
  BenchReport report;
  report.scenes = std::move(scenes);
  return report;
}

std::string adviceFor(const BenchReport& report, const std::string& need) {
  std::string text;
  for (const Advice& advice : recommend(report)) {
    if (advice.need == need) text += advice.text;
  }
  return text;
}

TEST(Recommendation, TheCheapestExactMethodOfEachStep) {
  const BenchReport report = reportOf({
      layersOf(1, {measuredAs("unsorted", 2, 0, false), measuredAs("linked-list", 4, 10, true),
                   measuredAs("a-buffer", 3, 20, true)}),
      layersOf(2, {measuredAs("unsorted", 2, 0, false), measuredAs("linked-list", 5, 11, true),
                   measuredAs("a-buffer", 8, 20, true)}),
      layersOf(4, {measuredAs("unsorted", 2, 0, false), measuredAs("linked-list", 6, 12, true),
                   measuredAs("a-buffer", 9, 20, true)}),
  });
  EXPECT_EQ(adviceFor(report, "Exact"),
            "At 1 layer a-buffer is the cheapest method that is exact in every frame: 1.50 times the cost of unsorted "
            "(3.000 ms) and 20.0 MiB. "
            "At 2 to 4 layers linked-list, standard is the cheapest method that is exact in every frame: 2.50 to 3.00 "
            "times the cost of "
            "unsorted (5.000 to 6.000 ms) and 11.0 to 12.0 MiB.");
  // It keeps less at 1 layer as well, where it is not the cheapest.
  EXPECT_EQ(
      adviceFor(report, "Little memory"),
      "At 1 to 4 layers the exact method that keeps the least memory is linked-list, standard: 2.00 to 3.00 times "
      "the cost of unsorted (4.000 to 6.000 ms) and 10.0 to 12.0 MiB.");
}

// The cheapest one keeps over a tenth more than the other, or a tenth.
TEST(Recommendation, LittleMemoryIsATenthLess) {
  const auto adviceWith = [](std::uint64_t mib) {
    return adviceFor(
        reportOf({layersOf(1, {measuredAs("linked-list", 3, mib, true), measuredAs("a-buffer", 9, 100, true)})}),
        "Little memory");
  };
  EXPECT_EQ(adviceWith(110), "");
  EXPECT_EQ(
      adviceWith(111),
      "At 1 layer the exact method that keeps the least memory is a-buffer: 4.50 times the cost of unsorted (9.000 "
      "ms) and 100.0 MiB.");
}

// Exact by promise goes before exact in the frames that were measured, whatever that costs.
TEST(Recommendation, AMethodThatIsExactInEveryFrameComesFirst) {
  const auto adviceWith = [](double insertion) {
    return adviceFor(
        reportOf({layersOf(1, {measuredAs("insertion", insertion, 10, true), measuredAs("linked-list", 4, 20, true)})}),
        "Exact");
  };
  const std::string first =
      "At 1 layer linked-list, standard is the cheapest method that is exact in every frame: 2.00 times the cost of "
      "unsorted (4.000 ms) and 20.0 MiB.";
  const std::string wrong = " It was exact in these frames; in others fragments of a pixel beyond 128 are dropped.";
  EXPECT_EQ(adviceWith(3),
            first + " insertion costs less: 1.50 times the cost of unsorted (3.000 ms) and 10.0 MiB." + wrong);
  EXPECT_EQ(adviceWith(3.7), first + " insertion costs at most a tenth less." + wrong);
  EXPECT_EQ(adviceWith(3.9), first + " insertion costs at most a tenth less." + wrong);
  EXPECT_EQ(adviceWith(4), first);
  EXPECT_EQ(adviceWith(5), first);
}

TEST(Recommendation, OneThatWasExactInTheseFramesIsNamedWhereItWas) {
  const BenchReport report = reportOf({
      layersOf(64, {measuredAs("insertion", 3, 10, true), measuredAs("linked-list", 4, 20, true)}),
      layersOf(128, {measuredAs("insertion", 3, 10, true), measuredAs("linked-list", 5, 20, true)}),
      layersOf(256, {measuredAs("insertion", 3, 10, false), measuredAs("linked-list", 6, 20, true)}),
  });
  EXPECT_EQ(adviceFor(report, "Exact"),
            "At 64 to 256 layers linked-list, standard is the cheapest method that is exact in every frame: 2.00 to "
            "3.00 times the cost of unsorted (4.000 to 6.000 ms) and 20.0 MiB. At 64 to 128 layers insertion costs "
            "less: 1.50 times the cost of unsorted (3.000 ms) and 10.0 MiB. It was exact in these frames; in others "
            "fragments of a pixel beyond 128 are dropped.");
  EXPECT_EQ(adviceFor(report, "Approximate will do"),
            "At 64 to 128 layers insertion is the cheapest order-independent method: 1.50 times the cost of unsorted "
            "(3.000 ms) and 10.0 MiB. It was exact in these frames; in others fragments of a pixel beyond 128 are "
            "dropped. At 256 layers no order-independent method that was measured is cheaper than the exact one.");
}

TEST(Recommendation, SaysWhatAMethodGetsWrongElsewhere) {
  const BenchReport report =
      reportOf({layersOf(1, {measuredAs("insertion", 3, 10, true), measuredAs("linked-list", 4, 20, false)})});
  EXPECT_EQ(
      adviceFor(report, "Exact"),
      "At 1 layer insertion is the cheapest exact method: 1.50 times the cost of unsorted (3.000 ms) and 10.0 MiB. "
      "It was exact in these frames; in others fragments of a pixel beyond 128 are dropped.");
  EXPECT_EQ(adviceFor(report, "Approximate will do"),
            "At 1 layer insertion is the cheapest order-independent method: 1.50 times the cost of unsorted (3.000 ms) "
            "and 10.0 MiB. It was exact in these frames; in others fragments of a pixel beyond 128 are dropped.");
}

TEST(Recommendation, NoiseDoesNotChangeTheAdviceFromStepToStep) {
  BenchReport report = reportOf({
      layersOf(1, {measuredAs("linked-list", 4.1, 10, true), measuredAs("a-buffer", 4.0, 20, true)}),
      layersOf(2, {measuredAs("linked-list", 5.0, 11, true), measuredAs("a-buffer", 5.1, 20, true)}),
      layersOf(4, {measuredAs("linked-list", 6.0, 12, true), measuredAs("a-buffer", 9.0, 20, true)}),
  });
  report.isCpu = true; // no times
  EXPECT_EQ(adviceFor(report, "Exact"),
            "At 1 to 4 layers linked-list, standard is the cheapest method that is exact in every frame: 2.05 to 3.00 "
            "times the cost of "
            "unsorted and 10.0 to 12.0 MiB.");
  report.scenes.pop_back();
  EXPECT_NE(adviceFor(report, "Exact").find("within the measured spread of it: "), std::string::npos)
      << adviceFor(report, "Exact");
}

// One round has no spread.
TEST(Recommendation, CostsThatAreNearlyEqualAreNotToldApart) {
  BenchReport report =
      reportOf({layersOf(1, {measuredAs("linked-list", 4.15, 10, true), measuredAs("a-buffer", 4, 10, true)})});
  for (Measurement& each : report.scenes[0].measurements) each.costMs = spreadOf({each.costMs.median});
  EXPECT_NE(adviceFor(report, "Exact").find("within the measured spread of it: linked-list, standard"),
            std::string::npos);
  report.scenes[0].measurements[0].costMs = spreadOf({4.25});
  EXPECT_EQ(adviceFor(report, "Exact").find("linked-list"), std::string::npos);
}

TEST(Recommendation, AnApproximateMethodHasToBeCheaper) {
  BenchReport report = reportOf({
      layersOf(1, {measuredAs("unsorted", 2, 0, false), measuredAs("linked-list", 3, 10, true)}),
  });
  EXPECT_EQ(adviceFor(report, "Approximate will do"),
            "At 1 layer no order-independent method that was measured is cheaper than the exact one.");
  // One whose cost can be told from the exact one's, and what it gets wrong.
  report.scenes[0].measurements.push_back(measuredAs("weighted", 2.5, 5, false));
  EXPECT_EQ(adviceFor(report, "Approximate will do"),
            "At 1 layer weighted is the cheapest order-independent method: 1.25 times the cost of unsorted (2.500 ms) "
            "and 5.0 MiB. It is not exact: near surfaces let too much through of what they hide: colours wash out "
            "towards their mean.");
  // Lists that were cut: what a method that can be exact gets wrong is not known.
  Measurement cut = measuredAs("linked-list", 2.5, 5, false);
  cut.options.nodes = VITRAIL_NODE_COMPACT;
  report.scenes[0].measurements.back() = cut;
  EXPECT_EQ(adviceFor(report, "Approximate will do"),
            "At 1 layer linked-list, compact is the cheapest order-independent method: 1.25 times the cost of unsorted "
            "(2.500 ms) and 5.0 MiB. It is not exact.");
  report.scenes[0].measurements.back().costMs.upperQuartile = 3.0;
  report.scenes[0].measurements.back().costMs.median = 2.99;
  EXPECT_NE(adviceFor(report, "Approximate will do").find("no order-independent method"), std::string::npos);
}

// What depends on the order of surfaces is never advised, however cheap it is; nor is what is not there.
TEST(Recommendation, SaysWhereNothingFits) {
  const BenchReport report = reportOf(
      {layersOf(1, {measuredAs("unsorted", 2, 0, false)}), layersOf(2, {measuredAs("unsorted", 2, 0, false)})});
  EXPECT_EQ(adviceFor(report, "Exact"), "At 1 to 2 layers no method that was measured is exact.");
  EXPECT_EQ(adviceFor(report, "Approximate will do"), "At 1 to 2 layers no order-independent method was measured.");
  EXPECT_EQ(adviceFor(report, "Little memory"), "");
}

TEST(Recommendation, WordsOfEachSweep) {
  const auto textOf = [](std::optional<SweepPlace> place) {
    SceneMeasurement scene = layersOf(1, {measuredAs("linked-list", 3, 1, true)});
    scene.sweep = std::move(place);
    const std::string text = adviceFor(reportOf({scene}), "Exact");
    return text.substr(0, text.find(" linked-list"));
  };
  EXPECT_EQ(textOf({}), "In planes");
  EXPECT_EQ(textOf(SweepPlace{SweepKind::Triangles, 33000.0, "33 k"}), "With 33 k triangles");
  EXPECT_EQ(textOf(SweepPlace{SweepKind::Resolution, 57600.0, "320x180"}), "At 320x180 pixels");
  EXPECT_EQ(textOf(SweepPlace{SweepKind::Samples, 4.0, "4"}), "With 4 samples a pixel");
}

// A step at which all was skipped says nothing; neither does a sample count beyond the smallest.
TEST(Recommendation, CountsWhatHasTheFewestSamples) {
  Measurement multisampled = measuredAs("linked-list", 1, 1, true);
  multisampled.options.samples = 4;
  const BenchReport report =
      reportOf({layersOf(1, {multisampled, measuredAs("linked-list", 3, 10, true)}), layersOf(2, {})});
  EXPECT_EQ(adviceFor(report, "Exact"),
            "At 1 layer linked-list, standard is the cheapest method that is exact in every frame: 1.50 times the cost "
            "of unsorted (3.000 ms) "
            "and 10.0 MiB.");
}

} // namespace
} // namespace vitrail::tests
