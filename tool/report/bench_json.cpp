#include "bench_json.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "../bench/matrix.h"
#include "../methods/methods.h"
#include "json.h"
#include "names.h"
#include "recommendation.h"

namespace vitrail::tool {

namespace {

// What measured and skipped settings begin with. `chosen` has the choices that were made, or taken.
Json settingOf(const MethodOptions& options, const FrameStats& chosen, std::optional<SweepKind> sweep) {
  return {{names::kMethod, options.name},
          {names::kApi, apiOf(options)},
          {"setting", describeWithoutSamples(sweep ? withoutStep(options, *sweep) : options)},
          {names::kNodes, orNull(chosen.nodes)},
          {names::kSamples, options.samples},
          {names::kResolve, orNull(chosen.resolve)},
          {names::kListBuild, orNull(chosen.listBuild)},
          {names::kMaxLayers, limitOrNull(options.maxLayers)},
          {names::kPasses, limitOrNull(options.passes)},
          {names::kStencilMark, orNull(chosen.stencilMark)},
          {names::kMemoryBudget, limitOrNull(options.memoryBudget)},
          {names::kNodeCapacity, limitOrNull(options.nodeCapacity)}};
}

Json toJson(const Measurement& measured, std::optional<SweepKind> sweep) {
  const FrameReport& frame = measured.report;
  Json json = settingOf(measured.options, frame, sweep);
  json[names::kMsaaResolve] = orNull(frame.msaaResolve);
  json[names::kExact] = isExact(frame);
  json[names::kOverflowed] = hasOverflowed(measured);
  json[names::kApproximatePixels] = frame.counted ? Json(frame.approximatePixels) : Json(nullptr);
  json[names::kErrorBound] = errorBoundOf(frame);
  json[names::kFragments] = fragmentsOf(frame);
  json[names::kLayers] = layersOf(frame);
  json[names::kNodesBytes] = frame.counted ? Json(frame.nodesBytes) : Json(nullptr);
  json[names::kMemoryBytes] = frame.totalBytes;
  json[names::kTiles] = frame.tiles;
  addCosts(json, measured);
  json["fragments_per_second"] = orNull(measured.fragmentsPerSecond);
  json["floor_bytes"] = orNull(measured.floorBytes);
  json["floor_ms"] = orNull(measured.floorMs);
  json["bandwidth_share"] = orNull(measured.bandwidthShare);
  return json;
}

Json toJson(const SkippedSetting& skipped, std::optional<SweepKind> sweep) {
  const MethodOptions& options = skipped.options;
  FrameStats chosen;
  if (traitsOf(options.name).takes(kTakesNodes)) chosen.nodes = nameOf(options.nodes);
  if (options.resolve != VITRAIL_RESOLVE_DEFAULT) chosen.resolve = nameOf(options.resolve);
  if (options.listBuild != VITRAIL_LIST_BUILD_DEFAULT) chosen.listBuild = nameOf(options.listBuild);
  if (options.stencilMark != StencilMark::On) chosen.stencilMark = nameOf(options.stencilMark);
  Json json = settingOf(options, chosen, sweep);
  const bool perSample = options.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  json[names::kMsaaResolve] = perSample ? Json(nameOf(options.msaaResolve)) : Json(nullptr);
  json["reason"] = skipped.reason;
  return json;
}

Json toJson(const SceneMeasurement& scene) {
  const std::optional<SweepKind> kind = scene.sweep ? std::optional(scene.sweep->kind) : std::nullopt;
  Json measurements = Json::array();
  for (const Measurement& measured : scene.measurements) measurements.push_back(toJson(measured, kind));
  Json skipped = Json::array();
  for (const SkippedSetting& setting : scene.skipped) skipped.push_back(toJson(setting, kind));
  const bool swept = scene.sweep.has_value();
  return {{names::kScene, scene.name},
          {names::kCount, orNull(scene.count)},
          {names::kSweep, swept ? Json(nameOf(scene.sweep->kind)) : Json(nullptr)},
          {names::kStep, swept ? Json(scene.sweep->value) : Json(nullptr)},
          {"label", swept ? Json(scene.sweep->label) : Json(nullptr)},
          {names::kWidth, scene.width},
          {names::kHeight, scene.height},
          {names::kTriangles, scene.triangles},
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

std::string toJson(const BenchReport& report) {
  Json scenes = Json::array();
  for (const SceneMeasurement& scene : report.scenes) scenes.push_back(toJson(scene));
  Json recommendation = Json::array();
  for (const Advice& advice : recommend(report)) {
    recommendation.push_back({{names::kSweep, advice.sweep ? Json(nameOf(*advice.sweep)) : Json(nullptr)},
                              {"need", advice.need},
                              {"text", advice.text}});
  }
  const std::optional<VkExtent2D> size = commonSize(report);
  Json json;
  addMachine(json, report);
  json[names::kWidth] = size ? Json(size->width) : Json(nullptr);
  json[names::kHeight] = size ? Json(size->height) : Json(nullptr);
  addRounds(json, report.repeats, report.warmups);
  json["bandwidth_gb_s"] = report.bytesPerSecond * 1e-9;
  json["recommendation"] = std::move(recommendation);
  json["scenes"] = std::move(scenes);
  json[names::kWarnings] = report.warnings;
  return documentOf(json);
}

} // namespace vitrail::tool
