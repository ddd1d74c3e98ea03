// The table of `vitrail compare`, of a comparison that is made up.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "methods/methods.h"
#include "report/comparison_table.h"

namespace vitrail::tests {
namespace {

using namespace vitrail::tool;

// Every method, each with the widest numbers that there are and more passes than a line holds.
Comparison wideComparison() {
  Comparison comparison;
  comparison.device = "Abacus";
  comparison.driver = "beads 1.0";
  comparison.api = "Vulkan 1.3";
  comparison.scene = "spheres";
  comparison.count = 20'000;
  comparison.width = comparison.height = 16'384;
  comparison.samples = 8;
  comparison.layersMax = 20'000;
  comparison.exactFrame.complete = true;
  comparison.exactFrame.fragmentsRequested = 99'999'999'999;
  for (const std::string_view name : methodNames()) {
    ComparedMethod method;
    method.measurement.options.name = name;
    method.measurement.costMs.median = method.measurement.frameMs.median = 99'999.94;
    method.measurement.costRatio = 9'999.994;
    method.measurement.report.totalBytes = std::uint64_t{99'999} << 20U;
    for (const char* pass :
         {"opaque", "depth_range", "absorbance", "stochastic", "accumulate", "composite", "box_filter"}) {
      method.measurement.passes.emplace_back(pass, Spread{99'999.94, 0.0, 0.0, 0.0, 0.0});
    }
    method.difference.metrics.psnr = 99.99;
    method.difference.metrics.ssim = -0.9999;
    method.difference.metrics.flip = 0.9999;
    method.difference.metrics.worst = 255;
    method.difference.metrics.worstX = method.difference.metrics.worstY = 9'999;
    method.difference.metrics.offShare = 0.999;
    comparison.methods.push_back(std::move(method));
  }
  return comparison;
}

TEST(ComparisonTable, FitsInto120Columns) {
  const std::string table = toTable(wideComparison());
  std::size_t longest = 0;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 120U) << line;
    longest = std::max(longest, line.size());
  }
  EXPECT_GT(longest, 110U) << "the numbers are not wide";
  for (const std::string_view name : methodNames()) {
    EXPECT_NE(table.find("\n " + std::string(name) + " "), std::string::npos) << name;
  }
  EXPECT_NE(table.find(",\n                       composite 99999.9, box_filter 99999.9\n"), std::string::npos)
      << table;
}

TEST(ComparisonTable, SaysWhatTheNumbersAreWorth) {
  Comparison comparison = wideComparison();
  const std::string plain = toTable(comparison);
  EXPECT_EQ(plain.find("not exact"), std::string::npos) << plain;
  EXPECT_EQ(plain.find("CPU"), std::string::npos) << plain;
  EXPECT_EQ(plain.find("--layers"), std::string::npos) << plain;
  comparison.isCpu = true;
  comparison.exactFrame.complete = false;
  comparison.limits = {16, 4};
  comparison.refused = {{"loop", "no room"}};
  const std::string table = toTable(comparison);
  for (const char* text :
       {"only the ratios say something", "\nThe picture that all are compared with is itself not exact.\n",
        "--layers 16 --passes 4\n", " left out loop: no room\n"}) {
    EXPECT_NE(table.find(text), std::string::npos) << text << " in\n" << table;
  }
}

} // namespace
} // namespace vitrail::tests
