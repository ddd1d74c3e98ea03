#include "runner.h"

#include <algorithm>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "../methods/methods.h"

namespace vitrail::tool {

namespace {

// A setting that the device can do, with what it has drawn so far.
struct Contender {
  MethodOptions options;
  RenderOptions picture;
  std::unique_ptr<Renderer> renderer;
  FrameReport report;            // of the first frame
  std::vector<PassTimes> frames; // with each step timed
  std::vector<PassTimes> wholes; // without
};

// A scene whose settings are set up and warm.
struct WarmScene {
  BenchRun run;
  std::uint64_t triangles = 0;
  std::vector<Contender> contenders;
  std::vector<SkippedSetting> skipped;
};

// The picture as a setting draws it.
RenderOptions pictureOf(const BenchRun& run, const MethodOptions& options) {
  RenderOptions picture = run.picture;
  if (options.memoryBudget > 0) picture.memoryBudget = std::uint64_t{options.memoryBudget} << 20U;
  return picture;
}

Contender prepare(Device& device, const Scene& scene, const BenchRun& run, const MethodOptions& options) {
  Contender contender;
  contender.options = options;
  contender.picture = pictureOf(run, options);
  contender.renderer = device.makeRenderer(scene, run.opacity, DrawOrder::Forward, options);
  for (std::uint32_t i = 0; i < run.warmups; ++i) contender.report = contender.renderer->measure(contender.picture);
  contender.picture.counts = false; // in the frames that are timed
  return contender;
}

// The transparent fragments of a picture, by a method that counts them.
std::uint64_t countFragments(Device& device, const Scene& scene, const BenchRun& run, std::uint32_t samples) {
  MethodOptions options = device.exactMethod();
  options.nodes = VITRAIL_NODE_HDR; // which rounds no surface away
  options.samples = samples;
  return device.makeRenderer(scene, run.opacity, DrawOrder::Forward, options)->measure(run.picture).fragmentsRequested;
}

// Looks at the picture of each sample count that is measured.
void checkFragments(Device& device, const Scene& scene, const BenchRun& run, const std::vector<Contender>& contenders) {
  std::set<std::uint32_t> counts;
  for (const Contender& each : contenders) counts.insert(each.options.samples);
  for (const std::uint32_t samples : counts) {
    const auto counting = std::ranges::find_if(contenders, [&](const Contender& contender) {
      return contender.report.counted && contender.options.samples == samples;
    });
    requireFragments(counting != contenders.end() ? counting->report.fragmentsRequested
                                                  : countFragments(device, scene, run, samples));
  }
}

// Sets up and warms up all settings; what cannot be done goes to `skipped`. `place` is that of a step.
std::vector<Contender> prepareAll(Device& device, const Scene& scene, const BenchRun& run, const std::string& place,
                                  std::vector<SkippedSetting>& skipped) {
  std::vector<Contender> contenders;
  for (const MethodOptions& options : run.settings) {
    const auto refused = std::ranges::find_if(skipped, [&](const SkippedSetting& each) {
      return each.options.name == kBaselineMethod && each.options.samples == options.samples &&
             each.options.api == options.api;
    });
    if (refused != skipped.end() && !traitsOf(options.name).onProcessor) {
      skipped.push_back({options, refused->reason});
      continue;
    }
    if (run.progress) run.progress(place.empty() ? describe(options) : place + ", " + describe(options));
    try {
      contenders.push_back(prepare(device, scene, run, options));
    } catch (const GpuError& error) {
      skipped.push_back({options, error.what()});
    }
  }
  return contenders;
}

WarmScene prepareScene(Device& device, const Scene& scene, const BenchRun& run, const std::string& place = {}) {
  WarmScene warm{run, triangleCount(scene), {}, {}};
  warm.contenders = prepareAll(device, scene, run, place, warm.skipped);
  checkFragments(device, scene, run, warm.contenders);
  return warm;
}

// Draws all rounds of scenes that are measured with as many. Every frame of a round is of another setting or scene, but
// that methods of several steps draw one more, in which these are timed.
void drawRounds(std::vector<WarmScene>& scenes) {
  std::vector<Contender*> all;
  for (WarmScene& warm : scenes) {
    for (Contender& contender : warm.contenders) all.push_back(&contender);
  }
  const BenchRun& first = scenes.front().run;
  for (std::uint32_t round = 0; round < first.repeats; ++round) {
    if (first.progress) first.progress(fmt::format("round {} of {}", round + 1, first.repeats));
    for (std::size_t i = 0; i < all.size(); ++i) {
      Contender& contender = *all[(round + i) % all.size()];
      contender.picture.timesSteps = false;
      contender.wholes.push_back(contender.renderer->measure(contender.picture).passesMs);
      contender.picture.timesSteps = true;
      const bool hasSteps = contender.wholes.back().size() < contender.report.passesMs.size();
      contender.frames.push_back(hasSteps ? contender.renderer->measure(contender.picture).passesMs
                                          : contender.wholes.back());
    }
  }
}

SceneMeasurement finish(WarmScene& warm) {
  SceneMeasurement result;
  result.triangles = warm.triangles;
  result.width = warm.run.picture.width;
  result.height = warm.run.picture.height;
  result.skipped = std::move(warm.skipped);
  for (const Contender& contender : warm.contenders) {
    if (warm.run.takePicture) warm.run.takePicture(contender.options, contender.renderer->render(contender.picture));
    result.measurements.push_back(summarize(contender.options, contender.report, contender.frames, contender.wholes));
  }
  compare(result.measurements, warm.run.bytesPerSecond);
  return result;
}

void requireOne(const std::vector<SceneMeasurement>& measured) {
  const auto isEmpty = [](const SceneMeasurement& each) { return each.measurements.empty(); };
  if (std::ranges::all_of(measured, isEmpty)) throw GpuError(measured.front().skipped.front().reason);
}

// Whether scenes that wait for their rounds hold so little that methods are measured as if they had the device alone.
bool hasMemoryLeft(const Gpu& gpu) {
  const VkPhysicalDeviceMemoryProperties& memory = gpu.memoryProperties();
  VkDeviceSize largest = 0;
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    const VkMemoryHeap& heap = memory.memoryHeaps[i];
    if ((heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) largest = std::max(largest, heap.size);
  }
  return gpu.memoryHeld() < largest / 4;
}

} // namespace

SceneMeasurement measureScene(Device& device, const Scene& scene, const BenchRun& run) {
  std::vector<WarmScene> scenes;
  scenes.push_back(prepareScene(device, scene, run));
  if (scenes[0].contenders.empty()) throw GpuError(scenes[0].skipped.front().reason);
  drawRounds(scenes);
  return finish(scenes[0]);
}

std::vector<SceneMeasurement> measureSteps(Device& device, std::size_t count,
                                           const std::function<BenchStep(std::size_t index)>& step) {
  std::vector<SceneMeasurement> results;
  std::vector<WarmScene> waiting;
  for (std::size_t i = 0; i < count; ++i) {
    const BenchStep made = step(i);
    waiting.push_back(prepareScene(device, made.scene, made.run, made.place));
    if (i + 1 < count && (device.gpu() == nullptr || hasMemoryLeft(*device.gpu()))) continue;
    drawRounds(waiting);
    for (WarmScene& warm : waiting) results.push_back(finish(warm));
    waiting.clear();
  }
  requireOne(results);
  return results;
}

void requireFragments(std::uint64_t transparentFragments) {
  if (transparentFragments > 0) return;
  throw std::runtime_error(
      "nothing transparent is in the picture, so there is nothing to measure: choose another model, or make it "
      "translucent with --opacity");
}

} // namespace vitrail::tool
