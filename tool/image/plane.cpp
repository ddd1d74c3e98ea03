#include "plane.h"

#include <algorithm>

namespace vitrail::tool {

namespace {

// A row with its first and last value repeated `radius` times.
void extendRow(const double* row, std::uint32_t width, std::size_t radius, std::vector<double>& extended) {
  std::fill_n(extended.begin(), radius, row[0]);
  std::copy_n(row, width, extended.begin() + static_cast<std::ptrdiff_t>(radius));
  std::fill_n(extended.begin() + static_cast<std::ptrdiff_t>(radius + width), radius, row[width - 1]);
}

// sum += weight * row, a whole row at a time, which compilers vectorize.
void addWeighted(double* sum, const double* row, double weight, std::uint32_t width) {
  for (std::uint32_t x = 0; x < width; ++x) sum[x] += weight * row[x];
}

Plane filterRows(const Plane& source, std::span<const double> weights) {
  Plane result(source.width, source.height);
  const std::size_t radius = weights.size() / 2;
  std::vector<double> extended(source.width + 2 * radius);
  for (std::uint32_t y = 0; y < source.height; ++y) {
    const std::size_t first = std::size_t{y} * source.width;
    extendRow(&source.values[first], source.width, radius, extended);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      addWeighted(&result.values[first], &extended[i], weights[i], source.width);
    }
  }
  return result;
}

Plane filterColumns(const Plane& source, std::span<const double> weights) {
  Plane result(source.width, source.height);
  const auto radius = static_cast<std::ptrdiff_t>(weights.size() / 2);
  const auto last = static_cast<std::ptrdiff_t>(source.height) - 1;
  for (std::ptrdiff_t y = 0; y <= last; ++y) {
    double* sum = &result.values[static_cast<std::size_t>(y) * source.width];
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const auto from = std::clamp<std::ptrdiff_t>(y + static_cast<std::ptrdiff_t>(i) - radius, 0, last);
      addWeighted(sum, &source.values[static_cast<std::size_t>(from) * source.width], weights[i], source.width);
    }
  }
  return result;
}

} // namespace

Plane filter(const Plane& source, std::span<const double> alongRows, std::span<const double> alongColumns) {
  return filterColumns(filterRows(source, alongRows), alongColumns);
}

} // namespace vitrail::tool
