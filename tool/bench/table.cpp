#include "table.h"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "matrix.h"

namespace vitrail::tool {

namespace {

constexpr const char* kNone = "-";

// One row: method, nodes, samples, resolve, then numbers.
constexpr char kRow[] = " {:<16} {:<9}{:>2} {:<9}{:>7}{:>8}{:>8}{:>8}{:>6}{:>7}{:>8}{:>7}{:>8}{:>8}{:>6}\n";

constexpr const char* kLegend =
    R"(Milliseconds of GPU time, medians. draw: collecting or blending the surfaces; cost: all passes but the opaque one,
in each frame; IQR: its interquartile range over its median; x: times unsorted's; M/s: million fragments a second of
cost; floor: the least time that the frame's bytes take at the measured bandwidth; bw: floor over cost.
)";

std::string milliseconds(double value) {
  return value < 1000.0 ? fmt::format("{:.3f}", value) : fmt::format("{:.1f}", value);
}

std::string percent(double fraction) {
  if (!std::isfinite(fraction)) return kNone;
  return fmt::format("{:.{}f}%", fraction * 100.0, fraction < 0.0995 ? 1 : 0);
}

std::string ratio(double value) { return std::isfinite(value) ? fmt::format("{:.2f}", value) : kNone; }

// The median of the pass that has one of these names.
std::string passTime(const Measurement& measured, std::string_view name, std::string_view otherName = "") {
  for (const auto& [pass, spread] : measured.passes) {
    if (pass == name || pass == otherName) return milliseconds(spread.median);
  }
  return kNone;
}

std::string rate(double perSecond) { return fmt::format("{:.{}f}", perSecond * 1e-6, perSecond < 1e8 ? 1 : 0); }

std::string text(const std::string& value) { return value.empty() ? kNone : value; }

std::string countText(std::uint64_t count) {
  const auto value = static_cast<double>(count);
  return count >= 1'000'000 ? fmt::format("{:.1f} M", value / 1e6) : fmt::format("{}", count);
}

std::string rowOf(const Measurement& measured) {
  const FrameReport& frame = measured.report;
  return fmt::format(kRow, measured.options.name, text(frame.nodes), frame.samples, text(frame.resolve),
                     passTime(measured, "clear"), passTime(measured, "collect", "blend"),
                     passTime(measured, "resolve", "box_filter"), milliseconds(measured.costMs.median),
                     percent(relativeRange(measured.costMs)), ratio(measured.costRatio),
                     milliseconds(measured.frameMs.median), ratio(measured.frameRatio),
                     measured.fragmentsPerSecond ? rate(*measured.fragmentsPerSecond) : kNone,
                     measured.floorMs ? milliseconds(*measured.floorMs) : kNone,
                     measured.bandwidthShare ? percent(*measured.bandwidthShare) : kNone);
}

// What has to be known of a measurement beside its numbers.
std::string noteOn(const Measurement& measured) {
  const FrameReport& frame = measured.report;
  if (frame.tiles > 1)
    return fmt::format(" {} drew {} tiles, in less memory\n", describe(measured.options), frame.tiles);
  if (!frame.counted || frame.exact) return {};
  if (frame.fragmentsMissing == 0) return fmt::format(" not exact: {}\n", describe(measured.options));
  return fmt::format(" not exact: {} left out {} of {} fragments; the deepest pixel has {}\n",
                     describe(measured.options), frame.fragmentsMissing, frame.fragmentsRequested, frame.layersMax);
}

std::string sceneTitle(const SceneMeasurement& scene) {
  std::string title = fmt::format("\n{}", scene.name);
  if (scene.count) title += fmt::format(" --count {}", *scene.count);
  title += fmt::format(": {} triangles", countText(scene.triangles));
  for (const Measurement& measured : scene.measurements) {
    const FrameReport& frame = measured.report;
    if (!frame.counted) continue;
    title += fmt::format(", {} transparent fragments, {} deep, {:.1f} on average", countText(frame.fragmentsRequested),
                         frame.layersMax, frame.layersMean);
    break;
  }
  return title + "\n";
}

} // namespace

std::string toTable(const BenchReport& report) {
  std::string table = fmt::format("{} ({}), {}\n{}x{}; rounds: {}, warm-up frames: {}; a copy moves {:.1f} GB/s\n",
                                  report.device, report.driver, report.api, report.width, report.height, report.repeats,
                                  report.warmups, report.bytesPerSecond * 1e-9);
  if (report.isCpu) table += "This device is a CPU: only the ratios say something, its times are the machine's.\n";
  for (const SceneMeasurement& scene : report.scenes) {
    table += sceneTitle(scene);
    table += fmt::format(kRow, "method", "nodes", "AA", "resolve", "clear", "draw", "resolve", "cost", "IQR", "x",
                         "frame", "x", "M/s", "floor", "bw");
    for (const Measurement& measured : scene.measurements) table += rowOf(measured);
    for (const Measurement& measured : scene.measurements) table += noteOn(measured);
    for (const SkippedSetting& skipped : scene.skipped) {
      table += fmt::format(" skipped {}: {}\n", describe(skipped.options), skipped.reason);
    }
  }
  return table + '\n' + kLegend;
}

} // namespace vitrail::tool
