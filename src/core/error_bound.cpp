#include "error_bound.h"

#include <algorithm>
#include <cmath>

#include "pool.h"
#include "vitrail/types.h"

namespace vitrail {

namespace {

constexpr double kPictureRounding = 0.5; // an 8-bit picture rounds, too
constexpr double kSteps = 255.0;

double srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

// Alpha in whole steps, colours on the curve in whole steps: each layer may be off by half a step of alpha times all
// light, and the curve is steepest in the dark.
double ofSteps(double alphaSteps, double colorSteps, std::uint32_t layers) {
  const double light = std::min(1.0, layers * 0.5 / alphaSteps);
  return kPictureRounding + kSteps * (srgb(light) + 0.5 / colorSteps);
}

} // namespace

float nodeErrorBound(std::uint32_t format, std::uint32_t samples, std::uint32_t layers) {
  if (maxNodeIndexCount(format, samples) == 0) return static_cast<float>(kSteps);
  double bound = kPictureRounding;
  if (layers > 0 && format == layout::VITRAIL_FORMAT_HDR) bound += 0.06 + 0.007 * std::sqrt(layers);
  // Fragments that are rounded to nothing are not counted: where there seem to be none, there may be one.
  const std::uint32_t least = std::max(layers, 1U);
  if (format == layout::VITRAIL_FORMAT_STANDARD) bound = ofSteps(255.0, 255.0, least);
  if (format == layout::VITRAIL_FORMAT_COMPACT)
    bound = samples == 1 ? ofSteps(63.0, 31.0, least) : ofSteps(31.0, 31.0, least);
  return static_cast<float>(std::min(bound, kSteps));
}

} // namespace vitrail

extern "C" float vitrailNodeErrorBound(VitrailNodeFormat format, uint32_t samples, uint32_t layers) {
  return vitrail::nodeErrorBound(format, samples, layers);
}
