#include "bench_table.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "../bench/matrix.h"
#include "../bench/short_count.h"
#include "../methods/methods.h"
#include "cells.h"
#include "recommendation.h"

namespace vitrail::tool {

namespace {

constexpr const char* kNone = "-";

// One row: the setting in so many columns, samples, then numbers.
constexpr char kBenchRow[] = " {:<{}}{:>3}{:>10}{:>7}{:>8}{:>10}{:>8}{:>9}{:>9}{:>7}{:>12}\n";

constexpr const char* kBenchLegend =
    R"(Milliseconds, medians. cost: all passes but the opaque one, of frames that time no steps; IQR: its interquartile
range over its median; x: times unsorted's; frame: all passes; M/s: million fragments a second of cost; floor: the least
time that a frame with lists, or of tiles, takes to move its bytes at the measured bandwidth; bw: floor over cost.
)";

std::string percent(double fraction) {
  if (!std::isfinite(fraction)) return kNone;
  return fmt::format("{:.{}f}%", fraction * 100.0, fraction < 0.0995 ? 1 : 0);
}

std::string rate(double perSecond) { return fmt::format("{:.{}f}", perSecond * 1e-6, perSecond < 1e8 ? 1 : 0); }

// What was measured: the setting, with the resolve that was taken.
std::string settingOf(const Measurement& measured) {
  MethodOptions options = measured.options;
  if (const std::optional<VitrailResolve> taken = resolveNamed(measured.report.resolve)) options.resolve = *taken;
  return describeWithoutSamples(options);
}

std::size_t settingColumns(const SceneMeasurement& scene) {
  std::size_t columns = 32;
  for (const Measurement& measured : scene.measurements) columns = std::max(columns, settingOf(measured).size() + 1);
  return columns;
}

std::string rowOf(const Measurement& measured, std::size_t columns) {
  const FrameReport& frame = measured.report;
  return fmt::format(kBenchRow, settingOf(measured), columns, frame.samples, milliseconds(measured.costMs.median),
                     percent(relativeRange(measured.costMs)), ratio(measured.costRatio),
                     milliseconds(measured.frameMs.median), ratio(measured.frameRatio),
                     measured.fragmentsPerSecond ? rate(*measured.fragmentsPerSecond) : kNone,
                     measured.floorMs ? milliseconds(*measured.floorMs) : kNone,
                     measured.bandwidthShare ? percent(*measured.bandwidthShare) : kNone, mebibytes(frame.totalBytes));
}

// What stands before a setting's passes.
std::string labelOf(const Measurement& measured, std::size_t columns) {
  return fmt::format(" {:<{}}{:>3}  ", settingOf(measured), columns, measured.report.samples);
}

// What has to be known of a measurement beside its numbers.
std::string noteOn(const Measurement& measured) {
  const FrameReport& frame = measured.report;
  std::string note;
  if (frame.tiles > 1) {
    note = fmt::format(" {} drew {} tiles, in less memory\n", describe(measured.options), frame.tiles);
  }
  if (!frame.counted || frame.complete) return note;
  if (hasOverflowed(measured)) {
    return note + fmt::format(" not exact: {} overflowed: {} of {} fragments had no node; the frame is approximate\n",
                              describe(measured.options), frame.fragmentsMissing, frame.fragmentsRequested);
  }
  if (frame.fragmentsMissing == 0) return note + fmt::format(" not exact: {}\n", describe(measured.options));
  return note + fmt::format(" not exact: {} left out {} of {} fragments; the deepest pixel has {}\n",
                            describe(measured.options), frame.fragmentsMissing, frame.fragmentsRequested,
                            frame.layersMax);
}

std::string sceneTitle(const SceneMeasurement& scene) {
  std::string title = fmt::format("\n{}", scene.name);
  if (scene.count) title += fmt::format(" --count {}", *scene.count);
  title += fmt::format(", {}x{}: {} triangles", scene.width, scene.height, shortCount(scene.triangles));
  const bool allOverflowed = std::ranges::none_of(scene.measurements, [](const Measurement& measured) {
    return measured.report.counted && !hasOverflowed(measured);
  });
  for (const Measurement& measured : scene.measurements) {
    const FrameReport& frame = measured.report;
    if (!frame.counted || (hasOverflowed(measured) && !allOverflowed))
      continue; // those know the stored fragments' layers
    title += fmt::format(", {} transparent fragments, {} deep, {:.1f} on average", shortCount(frame.fragmentsRequested),
                         frame.layersMax, frame.layersMean);
    break;
  }
  return title + "\n";
}

std::string skippedOf(const SceneMeasurement& scene) {
  std::string text;
  for (const SkippedSetting& skipped : scene.skipped) {
    text += fmt::format(" skipped {}: {}\n", describe(skipped.options), skipped.reason);
  }
  return text;
}

// The same for all steps of a sweep: what is skipped at all of them is told once.
std::string skippedOf(const std::vector<const SceneMeasurement*>& steps) {
  std::map<std::string, std::vector<std::string>> labels; // of the steps, by text
  for (const SceneMeasurement* step : steps) {
    const auto baseline = std::ranges::find(step->skipped, kBaselineMethod,
                                            [](const SkippedSetting& skipped) { return skipped.options.name; });
    if (step->measurements.empty() && baseline != step->skipped.end()) {
      labels["every method: " + baseline->reason].push_back(step->sweep->label);
      continue;
    }
    for (const SkippedSetting& skipped : step->skipped) {
      labels[fmt::format("{}: {}", describe(skipped.options), skipped.reason)].push_back(step->sweep->label);
    }
  }
  std::string text;
  for (const auto& [what, where] : labels) {
    text += where.size() == steps.size() ? fmt::format(" skipped {}\n", what)
                                         : fmt::format(" skipped at {} {}\n", fmt::join(where, ", "), what);
  }
  return text;
}

std::string sceneTable(const SceneMeasurement& scene) {
  std::string table = sceneTitle(scene);
  const std::size_t columns = settingColumns(scene);
  table +=
      fmt::format(kBenchRow, "method", columns, "AA", "cost", "IQR", "x", "frame", "x", "M/s", "floor", "bw", "memory");
  for (const Measurement& measured : scene.measurements) table += rowOf(measured, columns);
  table += " passes\n";
  for (const Measurement& measured : scene.measurements) table += passTimesOf(labelOf(measured, columns), measured);
  for (const Measurement& measured : scene.measurements) table += noteOn(measured);
  return table + skippedOf(scene);
}

// A setting's name beside the steps of a sweep. It is the same at all steps.
std::string describeInSweep(const SceneMeasurement& step, const Measurement& measured) {
  return describe(withoutStep(measured.options, step.sweep->kind));
}

// A number of each setting at each step of a sweep: settings down, steps across.
std::string gridOf(const std::vector<const SceneMeasurement*>& steps, const std::vector<std::string>& settings,
                   const char* title, const std::function<std::string(const Measurement&)>& number) {
  std::size_t width = 35;
  for (const std::string& setting : settings) width = std::max(width, setting.size());
  std::string table = fmt::format(" {:<{}}", title, width);
  for (const SceneMeasurement* step : steps) table += fmt::format("{:>10}", step->sweep->label);
  table += '\n';
  for (const std::string& setting : settings) {
    table += fmt::format(" {:<{}}", setting, width);
    for (const SceneMeasurement* step : steps) {
      const auto found = std::ranges::find(
          step->measurements, setting, [&](const Measurement& measured) { return describeInSweep(*step, measured); });
      table += fmt::format("{:>10}", found != step->measurements.end() ? number(*found) : kNone);
    }
    table += '\n';
  }
  return table;
}

// Text in lines of at most kColumns, each of which begins with a space.
std::string wrapped(const std::string& text) {
  std::string lines;
  std::string line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > kColumns) {
      lines.append(line).append("\n");
      line.clear();
    }
    line.append(" ").append(word);
  }
  return lines.append(line).append("\n");
}

std::string adviceOf(const BenchReport& report) {
  std::string text = "\nWhich method to use here, from these measurements alone\n";
  for (const Advice& advice : recommend(report)) text += wrapped(advice.need + ": " + advice.text);
  return text;
}

std::string sweepTitle(const SceneMeasurement& first, SweepKind kind) {
  std::string title = fmt::format("\n{}: {}", nameOf(kind), first.name);
  if (first.count && kind != SweepKind::Layers) title += fmt::format(" --count {}", *first.count);
  if (kind != SweepKind::Resolution) title += fmt::format(", {}x{}", first.width, first.height);
  if (kind != SweepKind::Triangles && kind != SweepKind::Layers) {
    title += fmt::format(", {} triangles", shortCount(first.triangles));
  }
  return title + "\n";
}

std::string sweepTable(const BenchReport& report, SweepKind kind) {
  const std::vector<const SceneMeasurement*> steps = scenesOf(report, kind);
  std::vector<std::string> settings;
  for (const SceneMeasurement* step : steps) {
    for (const Measurement& measured : step->measurements) {
      const std::string setting = describeInSweep(*step, measured);
      if (std::ranges::count(settings, setting) == 0) settings.push_back(setting);
    }
  }
  std::string table = sweepTitle(*steps.front(), kind);
  if (report.hasDevice) {
    table += gridOf(steps, settings, "cost, times unsorted",
                    [](const Measurement& measured) { return ratio(measured.costRatio); });
  }
  if (!report.isCpu || !report.hasDevice) {
    table += gridOf(steps, settings, "cost, ms",
                    [](const Measurement& measured) { return milliseconds(measured.costMs.median); });
  }
  table += gridOf(steps, settings, "memory, MiB", [](const Measurement& measured) {
    return fmt::format("{:.1f}", static_cast<double>(measured.report.totalBytes) / (1024.0 * 1024.0));
  });
  for (const SceneMeasurement* step : steps) {
    for (const Measurement& measured : step->measurements) {
      std::istringstream notes(noteOn(measured));
      for (std::string note; std::getline(notes, note);) table += fmt::format("{} ({})\n", note, step->sweep->label);
    }
  }
  return table + skippedOf(steps);
}

} // namespace

std::string toTable(const BenchReport& report) {
  std::string table = fmt::format(
      "{} ({}), {}\nrounds: {}, warm-up frames: {}{}\n", report.device, report.driver, report.api, report.repeats,
      report.warmups,
      report.bytesPerSecond > 0.0 ? fmt::format("; a copy moves {:.1f} GB/s", report.bytesPerSecond * 1e-9) : "");
  table += describe(report.limits);
  const auto isCpuMethod = [](const Measurement& each) { return each.options.name == kCpuMethod; };
  table += notesOn(report, std::ranges::any_of(report.scenes, [&](const SceneMeasurement& scene) {
                     return std::ranges::any_of(scene.measurements, isCpuMethod);
                   }));
  bool hasScenes = false;
  for (const std::optional<SweepKind> sweep : sweepsOf(report)) {
    if (sweep) {
      table += sweepTable(report, *sweep);
      continue;
    }
    hasScenes = true;
    for (const SceneMeasurement* scene : scenesOf(report, {})) table += sceneTable(*scene);
  }
  if (hasScenes) table.append("\n").append(kBenchLegend);
  return table + adviceOf(report);
}

} // namespace vitrail::tool
