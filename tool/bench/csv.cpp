#include "csv.h"

#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vitrail::tool {

namespace {

constexpr std::string_view kHeader =
    "device,driver,cpu,sweep,step,scene,count,width,height,triangles,method,nodes,resolve,samples,exact,fragments,"
    "missing,layers_max,tiles,cost_ms,cost_lower_quartile_ms,cost_upper_quartile_ms,frame_ms,cost_ratio,frame_ratio,"
    "memory_bytes,max_layers,passes,linking\n";

std::string text(std::string_view value) {
  if (value.find_first_of("\",\r\n") == std::string_view::npos) return std::string(value);
  std::string quoted = "\"";
  for (const char c : value) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

// In as many digits as tell two numbers apart; infinite and undefined ones are left out.
std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string(); }

template <class Value>
std::string orEmpty(bool known, Value value) {
  return known ? fmt::format("{}", value) : std::string();
}

std::string rowOf(const BenchReport& report, const SceneMeasurement& scene, const Measurement& measured) {
  const FrameReport& frame = measured.report;
  const std::array cells{text(report.device),
                         text(report.driver),
                         fmt::format("{}", report.isCpu),
                         scene.sweep ? std::string(nameOf(scene.sweep->kind)) : std::string(),
                         scene.sweep ? number(scene.sweep->value) : std::string(),
                         text(scene.name),
                         orEmpty(scene.count.has_value(), scene.count.value_or(0)),
                         fmt::format("{}", scene.width),
                         fmt::format("{}", scene.height),
                         fmt::format("{}", scene.triangles),
                         measured.options.name,
                         frame.nodes,
                         frame.resolve,
                         fmt::format("{}", frame.samples),
                         fmt::format("{}", frame.exact),
                         orEmpty(frame.counted, frame.fragmentsRequested),
                         orEmpty(frame.counted, frame.fragmentsMissing),
                         orEmpty(frame.counted, frame.layersMax),
                         fmt::format("{}", frame.tiles),
                         number(measured.costMs.median),
                         number(measured.costMs.lowerQuartile),
                         number(measured.costMs.upperQuartile),
                         number(measured.frameMs.median),
                         number(measured.costRatio),
                         number(measured.frameRatio),
                         fmt::format("{}", frame.totalBytes),
                         orEmpty(measured.options.maxLayers > 0, measured.options.maxLayers),
                         orEmpty(measured.options.passes > 0, measured.options.passes),
                         frame.listBuild};
  return fmt::format("{}\n", fmt::join(cells, ","));
}

} // namespace

std::string toCsv(const BenchReport& report) {
  std::string csv(kHeader);
  for (const SceneMeasurement& scene : report.scenes) {
    for (const Measurement& measured : scene.measurements) csv += rowOf(report, scene, measured);
  }
  return csv;
}

} // namespace vitrail::tool
