#include "report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace vitrail::tool {

namespace {

std::string countText(std::uint64_t count) {
  const auto value = static_cast<double>(count);
  if (count >= 1'000'000) return fmt::format("{:.1f} M", value / 1e6);
  if (count >= 10'000) return fmt::format("{:.0f} k", value / 1e3);
  return fmt::format("{}", count);
}

} // namespace

std::string toJson(const FrameReport& report) {
  using Json = nlohmann::ordered_json;
  Json passes = Json::object();
  for (const auto& [name, milliseconds] : report.passesMs) passes[name] = milliseconds;
  const Json json = {
      {"device", report.device},
      {"api", report.api},
      {"method", report.method},
      {"width", report.width},
      {"height", report.height},
      {"samples", report.samples},
      {"exact", report.exact},
      {"fragments",
       {{"requested", report.fragmentsRequested},
        {"stored", report.fragmentsStored},
        {"missing", report.fragmentsMissing}}},
      {"layers", {{"max", report.layersMax}, {"mean", report.layersMean}}},
      {"memory",
       {{"nodes_bytes", report.nodesBytes}, {"heads_bytes", report.headsBytes}, {"peak_bytes", report.peakBytes}}},
      {"passes_ms", passes},
      {"frame_ms", report.frameMs},
  };
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string toSummary(const FrameReport& report) {
  return fmt::format("{}x{}, {} transparent fragments, {} deep, {}, {:.1f} ms on {}", report.width, report.height,
                     countText(report.fragmentsStored), report.layersMax, report.exact ? "exact" : "not exact",
                     report.frameMs, report.device);
}

} // namespace vitrail::tool
