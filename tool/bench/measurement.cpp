#include "measurement.h"

#include <algorithm>
#include <cmath>

#include "../methods/methods.h"
#include "traffic.h"

namespace vitrail::tool {

namespace {

constexpr const char* kOpaquePass = "opaque";

double sumOf(const PassTimes& passes, bool withOpaque) {
  double sum = 0.0;
  for (const auto& [name, milliseconds] : passes) {
    if (withOpaque || name != kOpaquePass) sum += milliseconds;
  }
  return sum;
}

FrameShape shapeOf(const FrameReport& report, VitrailNodeFormat nodes) {
  FrameShape frame;
  frame.pixels = std::uint64_t{report.width} * report.height;
  frame.fragments = report.fragmentsStored;
  if (report.layersMean > 0.0) {
    frame.coveredPixels =
        static_cast<std::uint64_t>(std::llround(static_cast<double>(report.fragmentsStored) / report.layersMean));
  }
  frame.nodeBytes = static_cast<std::uint32_t>(vitrailNodePoolSize(nodes, 1));
  frame.samples = report.samples;
  return frame;
}

bool sameSamples(const Measurement& a, const Measurement& b) { return a.options.samples == b.options.samples; }

// What counted the fragments of a frame: the frame itself, or for a method that counts none, that of one with as many
// samples. Null: nothing did.
const FrameReport* countedOf(const Measurement& measured, const std::vector<Measurement>& all) {
  if (measured.report.counted) return &measured.report;
  const auto counting = std::ranges::find_if(
      all, [&](const Measurement& each) { return each.report.counted && sameSamples(each, measured); });
  return counting != all.end() ? &counting->report : nullptr;
}

// The bytes that a frame must move, of the methods that traffic.h tells of.
std::optional<std::uint64_t> leastBytesOf(const Measurement& measured, const FrameReport* counted) {
  const MethodTraits& traits = traitsOf(measured.options.name);
  if (traits.lists && measured.report.counted) { // insertion has no choice: its nodes are these
    const VitrailNodeFormat nodes = traits.takes(kTakesNodes) ? measured.options.nodes : VITRAIL_NODE_STANDARD;
    return leastBytes(shapeOf(measured.report, nodes));
  }
  if (!measured.report.raster) return {};
  FrameShape frame = shapeOf(measured.report, VITRAIL_NODE_STANDARD);
  if (counted != nullptr) frame.coveredPixels = shapeOf(*counted, VITRAIL_NODE_STANDARD).coveredPixels;
  return leastRasterBytes(frame, *measured.report.raster);
}

void addFloor(Measurement& measured, const FrameReport* counted, double bytesPerSecond) {
  if (bytesPerSecond <= 0.0) return;
  measured.floorBytes = leastBytesOf(measured, counted);
  if (!measured.floorBytes) return;
  measured.floorMs = static_cast<double>(*measured.floorBytes) / bytesPerSecond * 1e3;
  if (measured.costMs.median > 0.0) measured.bandwidthShare = *measured.floorMs / measured.costMs.median;
}

} // namespace

Measurement summarize(const MethodOptions& options, const FrameReport& report, const std::vector<PassTimes>& frames,
                      const std::vector<PassTimes>& wholes) {
  Measurement result;
  result.options = options;
  result.report = report;
  std::vector<double> costs;
  std::vector<double> totals;
  for (const PassTimes& frame : wholes.empty() ? frames : wholes) {
    costs.push_back(sumOf(frame, false));
    totals.push_back(sumOf(frame, true));
  }
  result.costMs = spreadOf(std::move(costs));
  result.frameMs = spreadOf(std::move(totals));
  for (std::size_t pass = 0; pass < frames.front().size(); ++pass) {
    std::vector<double> times;
    times.reserve(frames.size());
    for (const PassTimes& frame : frames) times.push_back(frame.at(pass).second);
    result.passes.emplace_back(frames.front()[pass].first, spreadOf(std::move(times)));
  }
  return result;
}

void compare(std::vector<Measurement>& measurements, double bytesPerSecond) {
  for (Measurement& measured : measurements) {
    const auto baseline = std::ranges::find_if(measurements, [&](const Measurement& each) {
      return each.options.name == kBaselineMethod && sameSamples(each, measured) &&
             each.options.api == measured.options.api;
    });
    if (baseline != measurements.end()) {
      measured.costRatio = ratioOfMedians(measured.costMs, baseline->costMs);
      measured.frameRatio = ratioOfMedians(measured.frameMs, baseline->frameMs);
    }
    const FrameReport* counted = countedOf(measured, measurements);
    if (counted != nullptr && measured.costMs.median > 0.0) {
      measured.fragmentsPerSecond = static_cast<double>(counted->fragmentsRequested) / (measured.costMs.median * 1e-3);
    }
    addFloor(measured, counted, bytesPerSecond);
  }
}

} // namespace vitrail::tool
