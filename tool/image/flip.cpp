// The names of the paper's sections stand over the parts. Constants are the paper's.
#include "flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/glm.hpp>

#include "../scene/srgb.h"

namespace vitrail::tool {

namespace {

using Vec = glm::dvec3;

// sRGB's primaries with D65 at (0.31271, 0.32902), linear light to XYZ. Each column is a primary.
const glm::dmat3 kXyzFromRgb{{10135552.0 / 24577794.0, 2613072.0 / 12288897.0, 1425312.0 / 73733382.0},
                             {8788810.0 / 24577794.0, 8788810.0 / 12288897.0, 8788810.0 / 73733382.0},
                             {4435075.0 / 24577794.0, 887015.0 / 12288897.0, 70074185.0 / 73733382.0}};
const glm::dmat3 kRgbFromXyz = glm::inverse(kXyzFromRgb);
const Vec kWhite = kXyzFromRgb * Vec(1.0);

// YCxCz, which is linear in light, so that filters may run over it.
Vec ycxczOf(const Vec& rgb) {
  const Vec relative = kXyzFromRgb * rgb / kWhite;
  return {116.0 * relative.y - 16.0, 500.0 * (relative.x - relative.y), 200.0 * (relative.y - relative.z)};
}

Vec rgbOf(const Vec& ycxcz) {
  const double y = (ycxcz.x + 16.0) / 116.0;
  return kRgbFromXyz * (Vec(y + ycxcz.y / 500.0, y, y - ycxcz.z / 200.0) * kWhite);
}

// CIE 1976 L*a*b*, whose a* and b* shrink with the lightness (Hunt's effect).
Vec huntLabOf(const Vec& rgb) {
  const auto curve = [](double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
  };
  const Vec relative = kXyzFromRgb * rgb / kWhite;
  const Vec f(curve(relative.x), curve(relative.y), curve(relative.z));
  const double lightness = 116.0 * f.y - 16.0;
  return {lightness, 0.01 * lightness * 500.0 * (f.x - f.y), 0.01 * lightness * 200.0 * (f.y - f.z)};
}

// HyAB: lightness counts apart from the distance of the two chromatic coordinates.
double hyab(const Vec& p, const Vec& q) { return std::abs(p.x - q.x) + std::hypot(p.y - q.y, p.z - q.z); }

// Spatial filtering. The contrast sensitivity of each channel is a sum of Gaussians of amplitude a and scale b in the
// spatial frequency's square.
struct Gaussian {
  double amplitude;
  double scale;
};
constexpr Gaussian kAchromatic{1.0, 0.0047};
constexpr Gaussian kRedGreen{1.0, 0.0053};
constexpr std::array<Gaussian, 2> kBlueYellow{{{34.1, 0.04}, {13.5, 0.025}}};
constexpr double kLargestScale = 0.04;

int sensitivityRadius() {
  const double deviation = std::sqrt(kLargestScale / (2.0 * std::numbers::pi * std::numbers::pi)); // in degrees
  return static_cast<int>(std::ceil(3.0 * deviation * kFlipPixelsPerDegree));
}

// One Gaussian along a side, without its factor.
std::vector<double> sensitivityWeights(double scale) {
  const int radius = sensitivityRadius();
  std::vector<double> weights;
  for (int i = -radius; i <= radius; ++i) {
    const double degrees = i / kFlipPixelsPerDegree;
    weights.push_back(std::exp(-std::numbers::pi * std::numbers::pi * degrees * degrees / scale));
  }
  return weights;
}

double sumOf(const std::vector<double>& weights) {
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  return sum;
}

// Filters with a sum of Gaussians whose weights over the square window sum to 1. Each of them is separable.
Plane filterSensitivity(const Plane& plane, std::span<const Gaussian> gaussians) {
  std::vector<std::vector<double>> weights;
  std::vector<double> factors;
  double total = 0.0;
  for (const Gaussian& gaussian : gaussians) {
    weights.push_back(sensitivityWeights(gaussian.scale));
    factors.push_back(gaussian.amplitude * std::sqrt(std::numbers::pi / gaussian.scale));
    const double sum = sumOf(weights.back());
    total += factors.back() * sum * sum;
  }
  Plane result(plane.width, plane.height);
  for (std::size_t g = 0; g < weights.size(); ++g) {
    const Plane part = filter(plane, weights[g], weights[g]);
    for (std::size_t i = 0; i < part.values.size(); ++i) result.values[i] += factors[g] / total * part.values[i];
  }
  return result;
}

// Feature detection. Derivatives of a Gaussian whose peak-to-trough width is that of the human edge detector.
constexpr double kDetectorWidth = 0.082; // degrees

// The derivative of a Gaussian along one axis and the Gaussian along the other.
struct Detector {
  std::vector<double> along;
  std::vector<double> across;
};

// Over the square window the positive weights sum to 1 and the negative ones to -1.
void normalize(Detector& detector) {
  double positive = 0.0;
  double negative = 0.0;
  for (const double weight : detector.along) (weight > 0.0 ? positive : negative) += weight;
  const double across = sumOf(detector.across);
  for (double& weight : detector.along) weight /= (weight > 0.0 ? positive : -negative) * across;
}

// Of the first derivative, which finds edges, or the second, which finds points and lines.
Detector makeDetector(bool edges) {
  constexpr double kDeviation = 0.5 * kDetectorWidth * kFlipPixelsPerDegree; // pixels
  const int radius = static_cast<int>(std::ceil(3.0 * kDeviation));
  Detector detector;
  for (int i = -radius; i <= radius; ++i) {
    const double squared = i * i / (kDeviation * kDeviation);
    const double gaussian = std::exp(-0.5 * squared);
    detector.across.push_back(gaussian);
    detector.along.push_back((edges ? -i : squared - 1.0) * gaussian);
  }
  normalize(detector);
  return detector;
}

// How strong the feature is at each pixel, whatever its direction.
Plane detect(const Plane& achromatic, const Detector& detector) {
  Plane strength = filter(achromatic, detector.along, detector.across);
  const Plane vertical = filter(achromatic, detector.across, detector.along);
  for (std::size_t i = 0; i < strength.values.size(); ++i) {
    strength.values[i] = std::hypot(strength.values[i], vertical.values[i]);
  }
  return strength;
}

// The colour metric. Large differences are compressed: what is above kCompressed of the largest shares 1 - kKnee.
constexpr double kColorExponent = 0.7;
constexpr double kCompressed = 0.4;
constexpr double kKnee = 0.95;

double colorError(double distance, double largest) {
  const double error = std::pow(distance, kColorExponent);
  const double bound = kCompressed * largest;
  if (error < bound) return kKnee / bound * error;
  return kKnee + (error - bound) / (largest - bound) * (1.0 - kKnee);
}

constexpr double kFeatureExponent = 0.5;

} // namespace

FlipPicture flipPicture(const Picture& picture) {
  std::array<double, 256> linear{};
  for (int code = 0; code < 256; ++code) linear[static_cast<std::size_t>(code)] = linearFromSrgb(code / 255.0);
  Plane y(picture.width, picture.height);
  Plane cx = y;
  Plane cz = y;
  Plane achromatic = y;
  for (std::size_t i = 0; i < y.values.size(); ++i) {
    const std::uint8_t* pixel = &picture.rgba[i * 4];
    const Vec color = ycxczOf({linear[pixel[0]], linear[pixel[1]], linear[pixel[2]]});
    y.values[i] = color.x;
    cx.values[i] = color.y;
    cz.values[i] = color.z;
    achromatic.values[i] = (color.x + 16.0) / 116.0;
  }
  FlipPicture result;
  result.edges = detect(achromatic, makeDetector(true));
  result.points = detect(achromatic, makeDetector(false));
  result.lightness = filterSensitivity(y, {&kAchromatic, 1});
  result.a = filterSensitivity(cx, {&kRedGreen, 1});
  result.b = filterSensitivity(cz, kBlueYellow);
  for (std::size_t i = 0; i < y.values.size(); ++i) {
    const Vec filtered(result.lightness.values[i], result.a.values[i], result.b.values[i]);
    const Vec lab = huntLabOf(glm::clamp(rgbOf(filtered), 0.0, 1.0));
    result.lightness.values[i] = lab.x;
    result.a.values[i] = lab.y;
    result.b.values[i] = lab.z;
  }
  return result;
}

Plane flipErrors(const FlipPicture& reference, const FlipPicture& test) {
  // No two colours of sRGB are farther apart than green and blue.
  const double largest = std::pow(hyab(huntLabOf({0.0, 1.0, 0.0}), huntLabOf({0.0, 0.0, 1.0})), kColorExponent);
  const auto labAt = [](const FlipPicture& picture, std::size_t i) {
    return Vec(picture.lightness.values[i], picture.a.values[i], picture.b.values[i]);
  };
  Plane errors(reference.edges.width, reference.edges.height);
  for (std::size_t i = 0; i < errors.values.size(); ++i) {
    const double color = colorError(hyab(labAt(reference, i), labAt(test, i)), largest);
    const double feature = std::max(std::abs(reference.edges.values[i] - test.edges.values[i]),
                                    std::abs(reference.points.values[i] - test.points.values[i]));
    const double visible = std::pow(feature / std::numbers::sqrt2, kFeatureExponent);
    errors.values[i] = std::clamp(std::pow(color, 1.0 - visible), 0.0, 1.0);
  }
  return errors;
}

} // namespace vitrail::tool
