// Measures the settings of a matrix in one scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../render/device.h"
#include "measurement.h"

namespace vitrail::tool {

struct BenchRun {
  std::vector<MethodOptions> settings; // BenchSettings::measured
  RenderOptions picture;
  std::optional<float> opacity; // of every material
  std::uint32_t repeats = 1;    // rounds, at least 1
  std::uint32_t warmups = 1;    // frames before the first round, at least 1: the first one makes room for the others
  double bytesPerSecond = 0.0;  // measureBandwidth(); 0: floors are not wanted
  // Told of what is done, for people who wait: "linked-list, standard, 4 samples", "round 3 of 31".
  std::function<void(const std::string& what)> progress;
  // Given the picture of every setting, after the last round; not drawn where nobody wants it.
  std::function<void(const MethodOptions& options, RenderResult result)> takePicture;
};

// A scene of several that are measured in turns.
struct BenchStep {
  Scene scene;
  BenchRun run;
  std::string place; // "step 2 of 7": told while it is set up; rounds are of all steps
};

// Every round draws one frame of each setting, starting one setting later than the round before it, so that a device
// that grows warm or busy slows all of them alike. A setting that the device refuses is skipped, and all of a sample
// count whose baseline it refuses but those of the processor. Throws GpuError where nothing is left or where a frame
// fails that could be drawn before, std::runtime_error where nothing transparent is in the picture, which is counted
// where no method does.
SceneMeasurement measureScene(Device& device, const Scene& scene, const BenchRun& run);

// The same for several scenes, `count` of them, each made by `step` when its turn to be set up comes: a round draws one
// frame of each setting of each scene. All have as many rounds. Where what is set up holds a quarter of the device's
// memory, its rounds are drawn before more is set up. A scene in which every setting is skipped has no measurements;
// throws GpuError where that is so for all.
std::vector<SceneMeasurement> measureSteps(Device& device, std::size_t count,
                                           const std::function<BenchStep(std::size_t index)>& step);

// Throws std::runtime_error where a picture has none: then there is nothing to measure.
void requireFragments(std::uint64_t transparentFragments);

} // namespace vitrail::tool
