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

// The fragments of a frame: its own count, or for a method that counts none, that of one with as many samples.
std::optional<double> fragmentsOf(const Measurement& measured, const std::vector<Measurement>& all) {
  if (measured.report.counted) return static_cast<double>(measured.report.fragmentsRequested);
  const auto counting = std::ranges::find_if(
      all, [&](const Measurement& each) { return each.report.counted && sameSamples(each, measured); });
  if (counting == all.end()) return {};
  return static_cast<double>(counting->report.fragmentsRequested);
}

// Methods whose fragments lie in nodes of lists: traffic.h tells of no others.
bool hasLists(const Measurement& measured) { return traitsOf(measured.options.name).lists; }

void addFloor(Measurement& measured, double bytesPerSecond) {
  if (!hasLists(measured) || !measured.report.counted || bytesPerSecond <= 0.0) return;
  const bool choice = traitsOf(measured.options.name).takes(kTakesNodes); // insertion has none: its nodes are these
  const VitrailNodeFormat nodes = choice ? measured.options.nodes : VITRAIL_NODE_STANDARD;
  const std::uint64_t bytes = leastBytes(shapeOf(measured.report, nodes));
  measured.floorBytes = bytes;
  measured.floorMs = static_cast<double>(bytes) / bytesPerSecond * 1e3;
  if (measured.costMs.median > 0.0) measured.bandwidthShare = *measured.floorMs / measured.costMs.median;
}

} // namespace

Measurement summarize(const MethodOptions& options, const FrameReport& report, const std::vector<PassTimes>& frames) {
  Measurement result;
  result.options = options;
  result.report = report;
  std::vector<double> costs;
  std::vector<double> totals;
  for (const PassTimes& frame : frames) {
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
    const std::optional<double> fragments = fragmentsOf(measured, measurements);
    if (fragments && measured.costMs.median > 0.0) {
      measured.fragmentsPerSecond = *fragments / (measured.costMs.median * 1e-3);
    }
    addFloor(measured, bytesPerSecond);
  }
}

} // namespace vitrail::tool
