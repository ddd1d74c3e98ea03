#include "metrics_text.h"

#include <cmath>

#include <fmt/format.h>

namespace vitrail::tool {

std::string psnrText(double psnr) { return std::isinf(psnr) ? "inf" : fmt::format("{:.2f}", psnr); }

std::string ssimText(double ssim) {
  constexpr double kRounding = 1e-12;
  if (ssim < 1.0 - kRounding && ssim >= 0.99995) return ">0.9999";
  return fmt::format("{:.4f}", ssim);
}

std::string flipText(double flip) {
  if (flip > 0.0 && flip < 0.00005) return "<0.0001";
  return fmt::format("{:.4f}", flip);
}

std::string shareText(double share) {
  if (share == 0.0) return "0";
  if (share < 0.0005) return "<0.1 %";
  return fmt::format("{:.1f} %", 100.0 * share);
}

} // namespace vitrail::tool
