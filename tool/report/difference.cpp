#include "difference.h"

#include <fmt/format.h>

#include "json.h"
#include "metrics_text.h"
#include "names.h"

namespace vitrail::tool {

std::string toJson(const PictureComparison& comparison) {
  Json json = {{"expected", comparison.expected},
               {"test", comparison.test},
               {names::kWidth, comparison.width},
               {names::kHeight, comparison.height}};
  json.update(metricsOf(comparison.metrics));
  return documentOf(json);
}

std::string toTable(const PictureComparison& comparison) {
  const Metrics& metrics = comparison.metrics;
  std::string table =
      fmt::format("{} against {}, {}x{}{}\n", comparison.test, comparison.expected, comparison.width, comparison.height,
                  comparison.alpha ? ", over black and over white, the worse of the two" : "");
  const auto row = [&](const char* name, const std::string& value, const std::string& meaning) {
    table += fmt::format("  {:<12}{:>10}   {}\n", name, value, meaning);
  };
  row("PSNR", psnrText(metrics.psnr), "dB; inf: the pictures are equal");
  row("SSIM", ssimText(metrics.ssim), "1: the pictures are equal");
  row("FLIP", flipText(metrics.flip), "mean; 0: no difference is seen, 1: the largest there is");
  row("worst pixel", fmt::format("{}/255", metrics.worst),
      metrics.worst > 0 ? fmt::format("at {},{}", metrics.worstX, metrics.worstY) : std::string());
  row("off", shareText(metrics.offShare), "of the pixels, by more than 2/255");
  return table;
}

} // namespace vitrail::tool
