#include "report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "../bench/cells.h"

namespace vitrail::tool {

namespace {

using Json = nlohmann::ordered_json;

// A text, or null where there is none.
Json textOrNull(const std::string& text) { return text.empty() ? Json() : Json(text); }

} // namespace

std::string toJson(const FrameReport& report) {
  Json passes = Json::object();
  for (const auto& [name, milliseconds] : report.passesMs) passes[name] = milliseconds;
  Json fragments; // null: the method does not count them
  Json layers;
  if (report.counted) {
    fragments = {{"requested", report.fragmentsRequested},
                 {"stored", report.fragmentsStored},
                 {"missing", report.fragmentsMissing}};
    layers = {{"max", report.layersMax}, {"mean", report.layersMean}};
  }
  const Json json = {
      {"device", report.device},
      {"api", report.api},
      {"method", report.method},
      {"width", report.width},
      {"height", report.height},
      {"samples", report.samples},
      {"nodes", textOrNull(report.nodes)},
      {"resolve", textOrNull(report.resolve)},
      {"linking", textOrNull(report.listBuild)},
      {"msaa_resolve", textOrNull(report.msaaResolve)},
      {"exact", report.exact},
      {"fragments", fragments},
      {"layers", layers},
      {"approximate_pixels", report.approximatePixels},
      {"tiles", report.tiles},
      {"memory",
       {{"nodes_bytes", report.nodesBytes},
        {"heads_bytes", report.headsBytes},
        {"total_bytes", report.totalBytes},
        {"peak_bytes", report.peakBytes}}},
      {"passes_ms", passes},
      {"frame_ms", report.frameMs},
  };
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string toSummary(const FrameReport& report) {
  std::string text = fmt::format("{}x{}, ", report.width, report.height);
  if (report.samples > 1) text += fmt::format("{} samples, ", report.samples);
  if (report.counted) {
    text += fmt::format("{} transparent fragments, {} deep, {}, ", shortCount(report.fragmentsStored), report.layersMax,
                        report.exact ? "exact" : "not exact");
  } else {
    text += fmt::format("{}, not exact, ", report.method);
  }
  if (report.tiles > 1) text += fmt::format("{} tiles, ", report.tiles);
  return text + fmt::format("{:.1f} ms on {}", report.frameMs, report.device);
}

} // namespace vitrail::tool
