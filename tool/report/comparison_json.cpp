#include "comparison_json.h"

#include "bench_json.h"
#include "metrics_json.h"

namespace vitrail::tool {

namespace {

using Json = nlohmann::ordered_json;

Json toJson(const ComparedMethod& method) {
  const Measurement& measured = method.measurement;
  Json passes = Json::object();
  for (const auto& [name, spread] : measured.passes) passes[name] = toJson(spread);
  return {{"method", measured.options.name},
          {"max_layers", limitOrNull(measured.options.maxLayers)},
          {"passes", limitOrNull(measured.options.passes)},
          {"exact", measured.report.exact},
          {"metrics", toJson(method.difference.metrics)},
          {"passes_ms", std::move(passes)},
          {"cost_ms", toJson(measured.costMs)},
          {"frame_ms", toJson(measured.frameMs)},
          {"cost_ratio", measured.costRatio},
          {"frame_ratio", measured.frameRatio},
          {"memory_bytes", measured.report.totalBytes}};
}

} // namespace

std::string toJson(const Comparison& comparison) {
  Json methods = Json::array();
  for (const ComparedMethod& method : comparison.methods) methods.push_back(toJson(method));
  Json refused = Json::array();
  for (const RefusedMethod& method : comparison.refused) {
    refused.push_back({{"method", method.name}, {"reason", method.reason}});
  }
  const FrameReport& exact = comparison.exactFrame;
  const Json json = {{"device", comparison.device},
                     {"driver", comparison.driver},
                     {"api", comparison.api},
                     {"cpu", comparison.isCpu},
                     {"scene", comparison.scene},
                     {"count", comparison.count ? Json(*comparison.count) : Json(nullptr)},
                     {"triangles", comparison.triangles},
                     {"width", comparison.width},
                     {"height", comparison.height},
                     {"samples", comparison.samples},
                     {"repeats", comparison.repeats},
                     {"warmups", comparison.warmups},
                     {"exact_picture",
                      {{"method", exact.method},
                       {"nodes", exact.nodes},
                       {"exact", exact.exact},
                       {"fragments", exact.fragmentsRequested},
                       {"layers", {{"max", exact.layersMax}, {"mean", exact.layersMean}}}}},
                     {"layers_max", comparison.layersMax},
                     {"methods", std::move(methods)},
                     {"refused", std::move(refused)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace vitrail::tool
