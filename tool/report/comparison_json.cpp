#include "comparison_json.h"

#include <utility>

#include "../methods/methods.h"
#include "json.h"
#include "names.h"

namespace vitrail::tool {

namespace {

Json toJson(const ComparedMethod& method) {
  const Measurement& measured = method.measurement;
  Json json = {{names::kMethod, measured.options.name},
               {names::kApi, apiOf(measured.options)},
               {names::kMaxLayers, limitOrNull(measured.options.maxLayers)},
               {names::kPasses, limitOrNull(measured.options.passes)},
               {names::kExact, isExact(measured.report)},
               {names::kErrorBound, errorBoundOf(measured.report)},
               {"metrics", metricsOf(method.difference.metrics)}};
  addCosts(json, measured);
  json[names::kMemoryBytes] = measured.report.totalBytes;
  return json;
}

} // namespace

std::string toJson(const Comparison& comparison) {
  Json methods = Json::array();
  for (const ComparedMethod& method : comparison.methods) methods.push_back(toJson(method));
  Json refused = Json::array();
  for (const RefusedMethod& method : comparison.refused) {
    refused.push_back({{names::kMethod, method.name}, {"reason", method.reason}});
  }
  const FrameReport& exact = comparison.exactFrame;
  Json json;
  addMachine(json, comparison);
  json[names::kScene] = comparison.scene;
  json[names::kCount] = orNull(comparison.count);
  json[names::kTriangles] = comparison.triangles;
  json[names::kWidth] = comparison.width;
  json[names::kHeight] = comparison.height;
  json[names::kSamples] = comparison.samples;
  addRounds(json, comparison.repeats, comparison.warmups);
  json["exact_picture"] = {{names::kMethod, exact.method},
                           {names::kNodes, orNull(exact.nodes)},
                           {names::kExact, isExact(exact)},
                           {names::kErrorBound, errorBoundOf(exact)},
                           {names::kFragments, exact.fragmentsRequested},
                           {names::kLayers, layersOf(exact)}};
  json[names::kLayersMax] = comparison.layersMax;
  json["methods"] = std::move(methods);
  json["refused"] = std::move(refused);
  json[names::kWarnings] = comparison.warnings;
  return documentOf(json);
}

} // namespace vitrail::tool
