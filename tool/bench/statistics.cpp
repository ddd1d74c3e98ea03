#include "statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vitrail::tool {

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

// The value below which `fraction` of the sorted measurements lie.
double quantile(const std::vector<double>& sorted, double fraction) {
  const double place = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

double quotient(double dividend, double divisor) { return divisor == 0.0 ? kNotANumber : dividend / divisor; }

} // namespace

Spread spreadOf(std::vector<double> measurements) {
  if (measurements.empty()) throw std::invalid_argument("no measurements");
  std::sort(measurements.begin(), measurements.end());
  Spread spread;
  spread.median = quantile(measurements, 0.5);
  spread.lowerQuartile = quantile(measurements, 0.25);
  spread.upperQuartile = quantile(measurements, 0.75);
  spread.min = measurements.front();
  spread.max = measurements.back();
  return spread;
}

double relativeRange(const Spread& spread) {
  return quotient(spread.upperQuartile - spread.lowerQuartile, spread.median);
}

double ratioOfMedians(const Spread& measured, const Spread& baseline) {
  return quotient(measured.median, baseline.median);
}

} // namespace vitrail::tool
