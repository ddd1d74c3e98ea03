#include "frame.h"

#include <cmath>

#include <fmt/format.h>

#include "../bench/short_count.h"
#include "json.h"
#include "names.h"

namespace vitrail::tool {

std::string toJson(const FrameReport& report) {
  Json passes = Json::object();
  for (const auto& [name, milliseconds] : report.passesMs) passes[name] = milliseconds;
  return documentOf({
      {names::kDevice, report.device},
      {names::kApi, report.api},
      {names::kMethod, report.method},
      {names::kWidth, report.width},
      {names::kHeight, report.height},
      {names::kSamples, report.samples},
      {names::kNodes, orNull(report.nodes)},
      {names::kResolve, orNull(report.resolve)},
      {names::kListBuild, orNull(report.listBuild)},
      {"msaa_resolve", orNull(report.msaaResolve)},
      {names::kExact, isExact(report)},
      {names::kErrorBound, errorBoundOf(report)},
      {names::kFragments, fragmentsOf(report)},
      {names::kLayers, layersOf(report)},
      {"approximate_pixels", report.approximatePixels},
      {names::kTiles, report.tiles},
      {"memory",
       {{names::kNodesBytes, report.nodesBytes},
        {"heads_bytes", report.headsBytes},
        {"total_bytes", report.totalBytes},
        {"peak_bytes", report.peakBytes}}},
      {names::kPassesMs, passes},
      {names::kFrameMs, report.frameMs},
      {names::kWarnings, report.warnings},
  });
}

// What is known of how right the picture is.
std::string exactness(const FrameReport& report) {
  if (isExact(report)) return "exact";
  if (!report.complete) return "not exact";
  return fmt::format("complete, within {:.0f}/255", std::ceil(report.errorBound));
}

std::string toSummary(const FrameReport& report) {
  std::string text = fmt::format("{}x{}, ", report.width, report.height);
  if (report.samples > 1) text += fmt::format("{} samples, ", report.samples);
  if (report.counted) {
    text += fmt::format("{} transparent fragments, {} deep, {}, ", shortCount(report.fragmentsStored), report.layersMax,
                        exactness(report));
  } else {
    text += fmt::format("{}, not exact, ", report.method);
  }
  if (report.tiles > 1) text += fmt::format("{} tiles, ", report.tiles);
  return text + fmt::format("{:.1f} ms on {}", report.frameMs, report.device);
}

} // namespace vitrail::tool
