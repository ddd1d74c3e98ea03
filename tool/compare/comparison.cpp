#include "comparison.h"

#include <algorithm>
#include <utility>

#include "../bench/matrix.h"
#include "../bench/runner.h"
#include "../methods/methods.h"

namespace vitrail::tool {

namespace {

void tell(const ComparisonRun& run, const std::string& step) {
  if (run.progress) run.progress(step);
}

RenderResult drawExact(Device& device, const Scene& scene, const ComparisonRun& run) {
  MethodOptions options = device.exactMethod();
  options.nodes = VITRAIL_NODE_HDR;
  options.samples = run.samples;
  return device.makeRenderer(scene, run.opacity, DrawOrder::Forward, options)->render(run.picture);
}

// Fills in the fragments of each pixel.
void countLayers(Device& device, const Scene& scene, const ComparisonRun& run, Comparison& result) {
  MethodOptions options;
  options.name = kLayerCount;
  const FrameReport frame = device.makeRenderer(scene, run.opacity, DrawOrder::Forward, options)->measure(run.picture);
  result.layers = Plane(run.picture.width, run.picture.height);
  std::ranges::copy(frame.pixelLayers, result.layers.values.begin());
  result.layersMax = frame.layersMax;
}

// The baseline and the methods that were asked for, each once, less those that the options do not allow.
std::vector<MethodOptions> settingsOf(const ComparisonRun& run, std::vector<RefusedMethod>& refused) {
  BenchMatrix matrix;
  matrix.methods = run.methods;
  matrix.apis = run.apis;
  matrix.samples = {run.samples};
  matrix.limits = run.limits;
  BenchSettings settings = configurationsOf(matrix);
  for (const SkippedSetting& skipped : settings.skipped) {
    refused.push_back({labelOf(skipped.options), skipped.reason});
  }
  return std::move(settings.measured);
}

BenchRun benchOf(const ComparisonRun& run, std::vector<MethodOptions> settings) {
  BenchRun bench;
  bench.settings = std::move(settings);
  bench.picture = run.picture;
  bench.opacity = run.opacity;
  bench.repeats = run.repeats;
  bench.warmups = run.warmups;
  bench.progress = run.progress;
  return bench;
}

} // namespace

Comparison compareMethods(Device& device, const Scene& scene, const ComparisonRun& run) {
  Comparison result;
  static_cast<Machine&>(result) = machineOf(device);
  result.width = run.picture.width;
  result.height = run.picture.height;
  result.samples = run.samples;
  result.limits = run.limits;
  result.repeats = run.repeats;
  result.warmups = run.warmups;
  tell(run, "the exact picture");
  RenderResult exact = drawExact(device, scene, run);
  result.exact = std::move(exact.picture);
  result.isEmpty = exact.isEmpty;
  result.exactFrame = std::move(exact.report);
  requireFragments(result.exactFrame.fragmentsRequested);
  tell(run, "depth complexity");
  countLayers(device, scene, run, result);

  BenchRun bench = benchOf(run, settingsOf(run, result.refused));
  std::vector<Picture> pictures; // in the order of the measurements
  bench.takePicture = [&](const MethodOptions& options, RenderResult drawn) {
    tell(run, "picture of " + labelOf(options));
    pictures.push_back(std::move(drawn.picture));
  };
  SceneMeasurement measured = measureScene(device, scene, bench);
  result.triangles = measured.triangles;
  for (const SkippedSetting& skipped : measured.skipped)
    result.refused.push_back({labelOf(skipped.options), skipped.reason});

  const ComparedPicture reference(result.exact);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    tell(run, "difference of " + labelOf(measured.measurements[i].options));
    Difference difference = reference.differenceTo(pictures[i]);
    result.methods.push_back({std::move(measured.measurements[i]), std::move(pictures[i]), std::move(difference)});
  }
  return result;
}

} // namespace vitrail::tool
