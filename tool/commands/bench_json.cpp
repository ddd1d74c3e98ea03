#include "bench_json.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "../bench/matrix.h"
#include "../bench/recommendation.h"

namespace vitrail::tool {

namespace {

using Json = nlohmann::ordered_json;

template <class Value>
Json orNull(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json orNull(std::string_view name) { return name.empty() ? Json(nullptr) : Json(name); }

Json toJson(const Measurement& measured) {
  const FrameReport& frame = measured.report;
  Json passes = Json::object();
  for (const auto& [name, spread] : measured.passes) passes[name] = toJson(spread);
  Json json = {{"method", measured.options.name},
               {"setting", describeWithoutSamples(measured.options)},
               {"nodes", orNull(frame.nodes)},
               {"samples", frame.samples},
               {"resolve", orNull(frame.resolve)},
               {"linking", orNull(frame.listBuild)},
               {"max_layers", limitOrNull(measured.options.maxLayers)},
               {"passes", limitOrNull(measured.options.passes)},
               {"exact", frame.exact},
               {"fragments", nullptr},
               {"layers", nullptr},
               {"nodes_bytes", nullptr},
               {"memory_bytes", frame.totalBytes},
               {"tiles", frame.tiles},
               {"passes_ms", std::move(passes)},
               {"cost_ms", toJson(measured.costMs)},
               {"frame_ms", toJson(measured.frameMs)},
               {"cost_ratio", measured.costRatio},
               {"frame_ratio", measured.frameRatio},
               {"fragments_per_second", orNull(measured.fragmentsPerSecond)},
               {"floor_bytes", orNull(measured.floorBytes)},
               {"floor_ms", orNull(measured.floorMs)},
               {"bandwidth_share", orNull(measured.bandwidthShare)}};
  if (frame.counted) {
    json["fragments"] = {{"requested", frame.fragmentsRequested},
                         {"stored", frame.fragmentsStored},
                         {"missing", frame.fragmentsMissing}};
    json["layers"] = {{"max", frame.layersMax}, {"mean", frame.layersMean}};
    json["nodes_bytes"] = frame.nodesBytes;
  }
  return json;
}

Json toJson(const SkippedSetting& skipped) {
  const MethodOptions& options = skipped.options;
  const bool hasNodes = traitsOf(options.name).nodes;
  const bool chosen = options.resolve != VITRAIL_RESOLVE_DEFAULT;
  const bool chosenLinking = options.listBuild != VITRAIL_LIST_BUILD_DEFAULT;
  return {{"method", options.name},
          {"setting", describeWithoutSamples(options)},
          {"nodes", hasNodes ? Json(nameOf(options.nodes)) : Json(nullptr)},
          {"samples", options.samples},
          {"resolve", chosen ? Json(nameOf(options.resolve)) : Json(nullptr)},
          {"linking", chosenLinking ? Json(nameOf(options.listBuild)) : Json(nullptr)},
          {"max_layers", limitOrNull(options.maxLayers)},
          {"passes", limitOrNull(options.passes)},
          {"reason", skipped.reason}};
}

Json toJson(const SceneMeasurement& scene) {
  Json measurements = Json::array();
  for (const Measurement& measured : scene.measurements) measurements.push_back(toJson(measured));
  Json skipped = Json::array();
  for (const SkippedSetting& setting : scene.skipped) skipped.push_back(toJson(setting));
  const bool swept = scene.sweep.has_value();
  return {{"scene", scene.name},
          {"count", orNull(scene.count)},
          {"sweep", swept ? Json(nameOf(scene.sweep->kind)) : Json(nullptr)},
          {"step", swept ? Json(scene.sweep->value) : Json(nullptr)},
          {"label", swept ? Json(scene.sweep->label) : Json(nullptr)},
          {"width", scene.width},
          {"height", scene.height},
          {"triangles", scene.triangles},
          {"measurements", std::move(measurements)},
          {"skipped", std::move(skipped)}};
}

// The size of all pictures; nothing where they differ.
std::optional<VkExtent2D> commonSize(const BenchReport& report) {
  const SceneMeasurement& first = report.scenes.front();
  const bool same = std::ranges::all_of(report.scenes, [&](const SceneMeasurement& scene) {
    return scene.width == first.width && scene.height == first.height;
  });
  return same ? std::optional(VkExtent2D{first.width, first.height}) : std::nullopt;
}

} // namespace

nlohmann::ordered_json limitOrNull(std::uint32_t limit) { return limit > 0 ? Json(limit) : Json(nullptr); }

nlohmann::ordered_json toJson(const Spread& spread) {
  return {{"median", spread.median},
          {"lower_quartile", spread.lowerQuartile},
          {"upper_quartile", spread.upperQuartile},
          {"min", spread.min},
          {"max", spread.max}};
}

std::string toJson(const BenchReport& report) {
  Json scenes = Json::array();
  for (const SceneMeasurement& scene : report.scenes) scenes.push_back(toJson(scene));
  Json recommendation = Json::array();
  for (const Advice& advice : recommend(report)) {
    recommendation.push_back({{"sweep", advice.sweep ? Json(nameOf(*advice.sweep)) : Json(nullptr)},
                              {"need", advice.need},
                              {"text", advice.text}});
  }
  const std::optional<VkExtent2D> size = commonSize(report);
  const Json json = {{"device", report.device},
                     {"driver", report.driver},
                     {"api", report.api},
                     {"cpu", report.isCpu},
                     {"width", size ? Json(size->width) : Json(nullptr)},
                     {"height", size ? Json(size->height) : Json(nullptr)},
                     {"repeats", report.repeats},
                     {"warmups", report.warmups},
                     {"bandwidth_gb_s", report.bytesPerSecond * 1e-9},
                     {"recommendation", std::move(recommendation)},
                     {"scenes", std::move(scenes)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace vitrail::tool
