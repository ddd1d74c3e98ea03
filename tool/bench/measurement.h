// What a benchmark measured, and what follows from it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../render/frame_report.h"
#include "machine.h"
#include "matrix.h"
#include "statistics.h"
#include "sweep.h"

namespace vitrail::tool {

// One setting of a method in one scene.
struct Measurement {
  MethodOptions options;
  FrameReport report;                                 // of one frame: what it held. Its times are not used.
  std::vector<std::pair<std::string, Spread>> passes; // milliseconds, in order
  // Of frames in which steps are not timed: those of `passes` take somewhat longer together.
  Spread costMs;  // of what transparency costs in a frame: all passes but the opaque one
  Spread frameMs; // of all passes
  // Over the baseline's in the same scene with as many samples and the same API, from medians. NaN where there is none,
  // or it took no time.
  double costRatio = std::numeric_limits<double>::quiet_NaN();
  double frameRatio = std::numeric_limits<double>::quiet_NaN();
  // Transparent fragments over the median cost; of the baseline, which counts none, those of another method. None where
  // nothing counted them.
  std::optional<double> fragmentsPerSecond;
  // Of methods with fragment lists, and of tiles where a picture was drawn as a whole: the bytes that the frame must
  // move (traffic.h), how long that takes at the measured bandwidth, and the share of the cost that this is.
  std::optional<std::uint64_t> floorBytes;
  std::optional<double> floorMs;
  std::optional<double> bandwidthShare;
};

// Whether the fixed pool of Overflow::Approximate was too small: the picture is not exact.
inline bool hasOverflowed(const Measurement& measured) {
  return measured.options.nodeCapacity > 0 && measured.report.fragmentsMissing > 0;
}

struct SceneMeasurement {
  std::string name;
  std::optional<std::uint32_t> count; // of a built-in scene, where it was chosen
  std::optional<SweepPlace> sweep;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint64_t triangles = 0;
  std::vector<Measurement> measurements; // a sample count's baseline stands before what is compared with it
  std::vector<SkippedSetting> skipped;
};

struct BenchReport : Machine {
  std::uint32_t repeats = 0;
  std::uint32_t warmups = 0;
  MethodLimits limits;
  double bytesPerSecond = 0.0; // bandwidth.h
  std::vector<SceneMeasurement> scenes;
  std::vector<std::string> warnings; // of the scenes
};

// What a setting's frames say, all of which have the same passes. There is at least one. What a frame takes is what
// `wholes` say, frames with fewer time stamps; where there are none, `frames`. Ratios and rates are filled in by
// compare().
Measurement summarize(const MethodOptions& options, const FrameReport& report, const std::vector<PassTimes>& frames,
                      const std::vector<PassTimes>& wholes = {});

// Fills in ratios, rates and floors of all measurements of a scene. Each sample count of an API has its baseline.
// Without a bandwidth, 0, there are no floors.
void compare(std::vector<Measurement>& measurements, double bytesPerSecond);

} // namespace vitrail::tool
