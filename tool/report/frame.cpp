#include "frame.h"

#include <cmath>

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "../bench/short_count.h"
#include "json.h"
#include "names.h"

namespace vitrail::tool {

namespace {

// All but the warnings.
Json jsonOf(const FrameReport& report) {
  Json passes = Json::object();
  for (const auto& [name, milliseconds] : report.passesMs) passes[name] = milliseconds;
  return {
      {names::kDevice, report.device},
      {names::kApi, report.api},
      {names::kMethod, report.method},
      {names::kWidth, report.width},
      {names::kHeight, report.height},
      {names::kSamples, report.samples},
      {names::kNodes, orNull(report.nodes)},
      {names::kResolve, orNull(report.resolve)},
      {names::kListBuild, orNull(report.listBuild)},
      {names::kMsaaResolve, orNull(report.msaaResolve)},
      {names::kExact, isExact(report)},
      {names::kErrorBound, errorBoundOf(report)},
      {names::kFragments, fragmentsOf(report)},
      {names::kLayers, layersOf(report)},
      {names::kApproximatePixels, report.approximatePixels},
      {names::kTiles, report.tiles},
      {"peeled", report.peeled},
      {"memory",
       {{names::kNodesBytes, report.nodesBytes},
        {"heads_bytes", report.headsBytes},
        {"total_bytes", report.totalBytes},
        {"peak_bytes", report.peakBytes}}},
      {names::kPassesMs, passes},
      {names::kFrameMs, report.frameMs},
  };
}

// What is known of how right the picture is.
std::string exactness(const FrameReport& report) {
  std::string left; // what the words are about
  if (report.peeled == 1) left = " without the nearest surface of each pixel";
  if (report.peeled > 1) left = fmt::format(" without the {} nearest surfaces of each pixel", report.peeled);
  if (isExact(report)) return "exact" + left;
  if (!report.complete) return "not exact" + left;
  return fmt::format("complete{}, within {:.0f}/255", left, std::ceil(report.errorBound));
}

} // namespace

std::string toJson(const FrameReport& report) {
  Json json = jsonOf(report);
  json[names::kWarnings] = report.warnings;
  return documentOf(json);
}

std::string toJson(std::span<const NamedFrame> frames, std::span<const std::string> warnings) {
  Json list = Json::array();
  for (const NamedFrame& frame : frames) {
    Json json{{"file", frame.file}};
    json.update(jsonOf(frame.report));
    list.push_back(std::move(json));
  }
  return documentOf({{"frames", list}, {names::kWarnings, std::vector(warnings.begin(), warnings.end())}});
}

std::string toSummary(const FrameReport& report) {
  std::string text = fmt::format("{}x{}, ", report.width, report.height);
  if (report.samples > 1) text += fmt::format("{} samples, ", report.samples);
  if (report.counted) {
    text += fmt::format("{} transparent fragments, {} deep, {}, ", shortCount(report.fragmentsStored), report.layersMax,
                        exactness(report));
  } else {
    text += fmt::format("{}, {}, ", report.method, exactness(report));
  }
  if (report.tiles > 1) text += fmt::format("{} tiles, ", report.tiles);
  return text + fmt::format("{:.1f} ms on {}", report.frameMs, report.device);
}

std::string toSummary(std::span<const NamedFrame> frames) {
  const FrameReport& first = frames.front().report;
  FrameReport worst = first;
  std::uint32_t deepest = 0;
  double milliseconds = 0.0;
  for (const NamedFrame& frame : frames) {
    worst.complete = worst.complete && frame.report.complete;
    worst.errorBound = std::max(worst.errorBound, frame.report.errorBound);
    deepest = std::max(deepest, frame.report.layersMax);
    milliseconds += frame.report.frameMs / static_cast<double>(frames.size());
  }
  std::string text = fmt::format("{} pictures of {}x{}, ", frames.size(), first.width, first.height);
  if (first.samples > 1) text += fmt::format("{} samples, ", first.samples);
  text += first.counted ? fmt::format("up to {} deep, {}, ", deepest, exactness(worst))
                        : fmt::format("{}, {}, ", first.method, exactness(worst));
  return text + fmt::format("{:.1f} ms each on {}", milliseconds, first.device);
}

} // namespace vitrail::tool
