#include "runner.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "matrix.h"

namespace vitrail::tool {

namespace {

// A setting that the device can do, with what it has drawn so far.
struct Contender {
  MethodOptions options;
  std::unique_ptr<Renderer> renderer;
  FrameReport report; // of the first frame
  std::vector<PassTimes> frames;
};

Contender prepare(Gpu& gpu, const Scene& scene, const BenchRun& run, const MethodOptions& options) {
  Contender contender;
  contender.options = options;
  contender.renderer = std::make_unique<Renderer>(gpu, scene, run.opacity, DrawOrder::Forward, options);
  for (std::uint32_t i = 0; i < run.warmups; ++i) contender.report = contender.renderer->measure(run.picture);
  return contender;
}

// A picture without anything to blend costs nothing: no ratio would mean a thing.
void checkFragments(const std::vector<Contender>& contenders) {
  const bool empty = std::ranges::any_of(contenders, [](const Contender& contender) {
    return contender.report.counted && contender.report.fragmentsRequested == 0;
  });
  if (!empty) return;
  throw std::runtime_error(
      "nothing transparent is in the picture, so there is nothing to measure: choose another model, or make it "
      "translucent with --opacity");
}

// Sets up and warms up all settings; what cannot be done goes to `skipped`.
std::vector<Contender> prepareAll(Gpu& gpu, const Scene& scene, const BenchRun& run,
                                  std::vector<SkippedSetting>& skipped) {
  std::vector<Contender> contenders;
  for (const MethodOptions& options : run.settings) {
    const auto refused = std::ranges::find_if(skipped, [&](const SkippedSetting& each) {
      return each.options.name == kBaselineMethod && each.options.samples == options.samples;
    });
    if (refused != skipped.end()) {
      skipped.push_back({options, refused->reason});
      continue;
    }
    if (run.progress) run.progress(describe(options));
    try {
      contenders.push_back(prepare(gpu, scene, run, options));
    } catch (const GpuError& error) {
      skipped.push_back({options, error.what()});
    }
  }
  if (contenders.empty()) throw GpuError(skipped.front().reason);
  return contenders;
}

} // namespace

SceneMeasurement measureScene(Gpu& gpu, const Scene& scene, const BenchRun& run) {
  SceneMeasurement result;
  result.triangles = triangleCount(scene);
  std::vector<Contender> contenders = prepareAll(gpu, scene, run, result.skipped);
  checkFragments(contenders);
  const std::size_t count = contenders.size();
  for (std::uint32_t round = 0; round < run.repeats; ++round) {
    if (run.progress) run.progress(fmt::format("round {} of {}", round + 1, run.repeats));
    for (std::size_t i = 0; i < count; ++i) {
      Contender& contender = contenders[(round + i) % count];
      contender.frames.push_back(contender.renderer->measure(run.picture).passesMs);
    }
  }
  for (const Contender& contender : contenders) {
    if (run.takePicture) run.takePicture(contender.options, contender.renderer->render(run.picture));
    result.measurements.push_back(summarize(contender.options, contender.report, contender.frames));
  }
  compare(result.measurements, run.bytesPerSecond);
  return result;
}

} // namespace vitrail::tool
