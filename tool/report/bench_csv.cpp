#include "bench_csv.h"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "../methods/methods.h"
#include "names.h"

namespace vitrail::tool {

namespace {

std::string text(std::string_view value) {
  if (value.find_first_of("\",\r\n") == std::string_view::npos) return std::string(value);
  std::string quoted = "\"";
  for (const char c : value) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

// In as many digits as tell two numbers apart; infinite and undefined ones are left out.
std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string(); }

template <class Value>
std::string cell(Value value) {
  return fmt::format("{}", value);
}

template <class Value>
std::string orEmpty(bool known, Value value) {
  return known ? cell(value) : std::string();
}

// What a row is of.
struct CsvRow {
  const BenchReport& report;
  const SceneMeasurement& scene;
  const Measurement& measured;
  const FrameReport& frame;
};

struct CsvColumn {
  const char* name;
  std::string (*cell)(const CsvRow& row);
};

constexpr CsvColumn kCsvColumns[] = {
    {names::kDevice, [](const CsvRow& row) { return text(row.report.device); }},
    {names::kDriver, [](const CsvRow& row) { return text(row.report.driver); }},
    {names::kCpu, [](const CsvRow& row) { return cell(row.report.isCpu); }},
    {names::kSweep,
     [](const CsvRow& row) { return row.scene.sweep ? std::string(nameOf(row.scene.sweep->kind)) : std::string(); }},
    {names::kStep, [](const CsvRow& row) { return row.scene.sweep ? number(row.scene.sweep->value) : std::string(); }},
    {names::kScene, [](const CsvRow& row) { return text(row.scene.name); }},
    {names::kCount,
     [](const CsvRow& row) { return orEmpty(row.scene.count.has_value(), row.scene.count.value_or(0)); }},
    {names::kWidth, [](const CsvRow& row) { return cell(row.scene.width); }},
    {names::kHeight, [](const CsvRow& row) { return cell(row.scene.height); }},
    {names::kTriangles, [](const CsvRow& row) { return cell(row.scene.triangles); }},
    {names::kMethod, [](const CsvRow& row) { return row.measured.options.name; }},
    {names::kNodes, [](const CsvRow& row) { return row.frame.nodes; }},
    {names::kResolve, [](const CsvRow& row) { return row.frame.resolve; }},
    {names::kSamples, [](const CsvRow& row) { return cell(row.frame.samples); }},
    {names::kExact, [](const CsvRow& row) { return cell(isExact(row.frame)); }},
    {names::kFragments, [](const CsvRow& row) { return orEmpty(row.frame.counted, row.frame.fragmentsRequested); }},
    {names::kMissing, [](const CsvRow& row) { return orEmpty(row.frame.counted, row.frame.fragmentsMissing); }},
    {names::kLayersMax, [](const CsvRow& row) { return orEmpty(row.frame.counted, row.frame.layersMax); }},
    {names::kTiles, [](const CsvRow& row) { return cell(row.frame.tiles); }},
    {names::kCostMs, [](const CsvRow& row) { return number(row.measured.costMs.median); }},
    {"cost_lower_quartile_ms", [](const CsvRow& row) { return number(row.measured.costMs.lowerQuartile); }},
    {"cost_upper_quartile_ms", [](const CsvRow& row) { return number(row.measured.costMs.upperQuartile); }},
    {names::kFrameMs, [](const CsvRow& row) { return number(row.measured.frameMs.median); }},
    {names::kCostRatio, [](const CsvRow& row) { return number(row.measured.costRatio); }},
    {names::kFrameRatio, [](const CsvRow& row) { return number(row.measured.frameRatio); }},
    {names::kMemoryBytes, [](const CsvRow& row) { return cell(row.frame.totalBytes); }},
    {names::kMaxLayers,
     [](const CsvRow& row) { return orEmpty(row.measured.options.maxLayers > 0, row.measured.options.maxLayers); }},
    {names::kPasses,
     [](const CsvRow& row) { return orEmpty(row.measured.options.passes > 0, row.measured.options.passes); }},
    {names::kListBuild, [](const CsvRow& row) { return row.frame.listBuild; }},
    {names::kMsaaResolve, [](const CsvRow& row) { return row.frame.msaaResolve; }},
    {names::kStencilMark, [](const CsvRow& row) { return row.frame.stencilMark; }},
    {names::kMemoryBudget,
     [](const CsvRow& row) {
       return orEmpty(row.measured.options.memoryBudget > 0, row.measured.options.memoryBudget);
     }},
    {names::kNodeCapacity,
     [](const CsvRow& row) {
       return orEmpty(row.measured.options.nodeCapacity > 0, row.measured.options.nodeCapacity);
     }},
    {names::kOverflowed, [](const CsvRow& row) { return cell(hasOverflowed(row.measured)); }},
    {names::kApproximatePixels,
     [](const CsvRow& row) { return orEmpty(row.frame.counted, row.frame.approximatePixels); }},
    {names::kApi, [](const CsvRow& row) { return std::string(apiOf(row.measured.options)); }},
};

// One line of what `cellOf` says of every column.
template <class CellOf>
std::string lineOf(CellOf cellOf) {
  std::string line;
  for (const CsvColumn& column : kCsvColumns) line.append(line.empty() ? "" : ",").append(cellOf(column));
  return line + '\n';
}

} // namespace

std::string toCsv(const BenchReport& report) {
  std::string csv = lineOf([](const CsvColumn& column) { return column.name; });
  for (const SceneMeasurement& scene : report.scenes) {
    for (const Measurement& measured : scene.measurements) {
      const CsvRow row{report, scene, measured, measured.report};
      csv += lineOf([&](const CsvColumn& column) { return column.cell(row); });
    }
  }
  return csv;
}

} // namespace vitrail::tool
