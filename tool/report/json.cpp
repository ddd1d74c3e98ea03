#include "json.h"

#include <cmath>
#include <utility>

#include "names.h"

namespace vitrail::tool {

namespace {

// median, lower_quartile, upper_quartile, min, max, in the unit of the measurements.
Json jsonOf(const Spread& spread) {
  return {{"median", spread.median},
          {"lower_quartile", spread.lowerQuartile},
          {"upper_quartile", spread.upperQuartile},
          {"min", spread.min},
          {"max", spread.max}};
}

} // namespace

Json orNull(std::string_view text) { return text.empty() ? Json(nullptr) : Json(text); }

Json limitOrNull(std::uint32_t limit) { return limit > 0 ? Json(limit) : Json(nullptr); }

Json errorBoundOf(const FrameStats& frame) { return frame.complete ? Json(frame.errorBound) : Json(nullptr); }

Json fragmentsOf(const FrameStats& frame) {
  if (!frame.counted) return nullptr;
  return {{"requested", frame.fragmentsRequested},
          {"stored", frame.fragmentsStored},
          {names::kMissing, frame.fragmentsMissing}};
}

Json layersOf(const FrameStats& frame) {
  if (!frame.counted) return nullptr;
  return {{"max", frame.layersMax}, {"mean", frame.layersMean}};
}

Json passesOf(const Measurement& measured) {
  Json passes = Json::object();
  for (const auto& [name, spread] : measured.passes) passes[name] = jsonOf(spread);
  return passes;
}

void addCosts(Json& json, const Measurement& measured) {
  json[names::kPassesMs] = passesOf(measured);
  json[names::kCostMs] = jsonOf(measured.costMs);
  json[names::kFrameMs] = jsonOf(measured.frameMs);
  json[names::kCostRatio] = measured.costRatio;
  json[names::kFrameRatio] = measured.frameRatio;
}

void addMachine(Json& json, const Machine& machine) {
  json[names::kDevice] = machine.device;
  json[names::kDriver] = machine.driver;
  json[names::kApi] = machine.api;
  json[names::kCpu] = machine.isCpu;
  json["processor"] = machine.processor;
}

void addRounds(Json& json, std::uint32_t repeats, std::uint32_t warmups) {
  json["repeats"] = repeats;
  json["warmups"] = warmups;
}

Json metricsOf(const Metrics& metrics) {
  return {{"psnr_db", std::isinf(metrics.psnr) ? Json(nullptr) : Json(metrics.psnr)},
          {"ssim", metrics.ssim},
          {"flip", metrics.flip},
          {"worst", {{"x", metrics.worstX}, {"y", metrics.worstY}, {"difference", metrics.worst}}},
          {"off_share", metrics.offShare}};
}

std::string documentOf(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

} // namespace vitrail::tool
