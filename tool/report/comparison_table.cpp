#include "comparison_table.h"

#include <algorithm>

#include <fmt/format.h>

#include "../methods/methods.h"

#include "cells.h"
#include "metrics_text.h"

namespace vitrail::tool {

namespace {

// One row: method, five measures of the picture, cost and its ratio, frame, memory.
constexpr char kComparisonRow[] = " {:<22}{:>8}{:>9}{:>9}{:>17}{:>9}{:>11}{:>8}{:>11}{:>13}\n";

constexpr const char* kComparisonLegend =
    R"(PSNR in dB, inf: equal to the exact picture. SSIM 1: equal. FLIP 0: no difference is seen, 1: the largest there is.
worst: the largest difference of a channel, and its pixel. off: pixels that differ by more than 2/255 in any channel.
cost: milliseconds of GPU time for the transparent surfaces, x: times unsorted's; frame: the opaque ones too. Medians.
)";

std::string worstText(const Metrics& metrics) {
  return metrics.worst == 0 ? "0" : fmt::format("{} at {},{}", metrics.worst, metrics.worstX, metrics.worstY);
}

std::string rowOf(const ComparedMethod& method) {
  const Metrics& metrics = method.difference.metrics;
  const Measurement& measured = method.measurement;
  return fmt::format(kComparisonRow, labelOf(measured.options), psnrText(metrics.psnr), ssimText(metrics.ssim),
                     flipText(metrics.flip), worstText(metrics), shareText(metrics.offShare),
                     milliseconds(measured.costMs.median), ratio(measured.costRatio),
                     milliseconds(measured.frameMs.median), mebibytes(measured.report.totalBytes));
}

} // namespace

std::string toTable(const Comparison& comparison) {
  std::string table =
      fmt::format("{} ({}), {}\n{}", comparison.device, comparison.driver, comparison.api, comparison.scene);
  if (comparison.count) table += fmt::format(" --count {}", *comparison.count);
  table += fmt::format(", {}x{}, {} {} a pixel; {} transparent fragments, {} deep\n", comparison.width,
                       comparison.height, comparison.samples, comparison.samples > 1 ? "samples" : "sample",
                       comparison.exactFrame.fragmentsRequested, comparison.layersMax);
  table += describe(comparison.limits);
  table += notesOn(comparison, std::ranges::any_of(comparison.methods, [](const ComparedMethod& method) {
                     return method.measurement.options.name == kCpuMethod;
                   }));
  if (!isExact(comparison.exactFrame)) table += "The picture that all are compared with is itself not exact.\n";
  table += '\n';
  table +=
      fmt::format(kComparisonRow, "method", "PSNR", "SSIM", "FLIP", "worst", "off", "cost", "x", "frame", "memory");
  for (const ComparedMethod& method : comparison.methods) table += rowOf(method);
  table += "\n passes, ms\n";
  for (const ComparedMethod& method : comparison.methods) {
    table += passTimesOf(fmt::format(" {:<22}", labelOf(method.measurement.options)), method.measurement);
  }
  for (const RefusedMethod& refused : comparison.refused) {
    table += fmt::format(" left out {}: {}\n", refused.name, refused.reason);
  }
  return table + '\n' + kComparisonLegend;
}

} // namespace vitrail::tool
