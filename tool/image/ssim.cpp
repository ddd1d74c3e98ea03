#include "ssim.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "plane.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kWindow = 11;
constexpr double kDeviation = 1.5;
constexpr double kC1 = 0.01 * 255.0 * 0.01 * 255.0;
constexpr double kC2 = 0.03 * 255.0 * 0.03 * 255.0;

Plane lumaOf(const Picture& picture) {
  Plane luma(picture.width, picture.height);
  for (std::size_t i = 0; i < luma.values.size(); ++i) {
    const std::uint8_t* pixel = &picture.rgba[i * 4];
    luma.values[i] = 0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2];
  }
  return luma;
}

Plane product(const Plane& a, const Plane& b) {
  Plane result(a.width, a.height);
  std::transform(a.values.begin(), a.values.end(), b.values.begin(), result.values.begin(), std::multiplies<>());
  return result;
}

// The window along a side, its weights summing to 1.
std::vector<double> windowOf(std::uint32_t side) {
  const std::uint32_t size = side >= kWindow ? kWindow : side - 1 + side % 2;
  const double middle = (static_cast<double>(size) - 1.0) / 2.0;
  std::vector<double> weights(size);
  double sum = 0.0;
  for (std::uint32_t i = 0; i < size; ++i) {
    const double x = static_cast<double>(i) - middle;
    weights[i] = std::exp(-x * x / (2.0 * kDeviation * kDeviation));
    sum += weights[i];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

} // namespace

double ssim(const Picture& a, const Picture& b) {
  const std::vector<double> rows = windowOf(a.width);
  const std::vector<double> columns = windowOf(a.height);
  const auto mean = [&](const Plane& plane) { return filter(plane, rows, columns); };
  const Plane lumaA = lumaOf(a);
  const Plane lumaB = lumaOf(b);
  const Plane meanA = mean(lumaA);
  const Plane meanB = mean(lumaB);
  const Plane squareA = mean(product(lumaA, lumaA));
  const Plane squareB = mean(product(lumaB, lumaB));
  const Plane productAB = mean(product(lumaA, lumaB));

  const std::size_t left = rows.size() / 2;
  const std::size_t top = columns.size() / 2;
  double sum = 0.0;
  for (std::size_t y = top; y < a.height - top; ++y) {
    for (std::size_t x = left; x < a.width - left; ++x) {
      const std::size_t i = y * a.width + x;
      const double ma = meanA.values[i];
      const double mb = meanB.values[i];
      const double variances = squareA.values[i] - ma * ma + squareB.values[i] - mb * mb;
      const double covariance = productAB.values[i] - ma * mb;
      sum += (2.0 * ma * mb + kC1) * (2.0 * covariance + kC2) / ((ma * ma + mb * mb + kC1) * (variances + kC2));
    }
  }
  return sum / static_cast<double>((a.width - 2 * left) * (a.height - 2 * top));
}

} // namespace vitrail::tool
