#include "navigation.h"

#include <algorithm>
#include <cmath>

#include "../scene/turn.h"

namespace vitrail::tool {

namespace {

constexpr double kSteepest = 89.5; // degrees: straight down has no upright picture

} // namespace

void Navigation::begin(const Bounds& bounds, const View& view) {
  const glm::dvec3 middle = 0.5 * (glm::dvec3(bounds.min) + glm::dvec3(bounds.max));
  const double size = std::max(glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min)), 1.0e-12);
  const glm::dmat4 camera(view.cameraToWorld);
  const glm::dvec3 eye(camera[3]);
  const glm::dvec3 back = glm::normalize(glm::dvec3(camera[2]));
  // The point of the line of sight that is nearest to the scene's middle, or one before the camera.
  const double along = -glm::dot(middle - eye, back);
  least_ = 1.0e-4 * size;
  distance_ = along > 0.01 * size ? along : 0.5 * size;
  if (view.orthographic) {
    fov_ = 45.0;
    distance_ = view.halfHeight / std::tan(glm::radians(0.5 * fov_));
    target_ = eye - along * back;
  } else {
    fov_ = std::clamp(glm::degrees(static_cast<double>(view.verticalFov)), 1.0, 170.0);
    target_ = eye - distance_ * back;
  }
  elevation_ = std::clamp(glm::degrees(std::asin(std::clamp(back.y, -1.0, 1.0))), -kSteepest, kSteepest);
  // Straight down or up, the top of the picture says where the camera was before it was tilted.
  const bool steep = std::abs(back.y) > 0.9999;
  const glm::dvec3 level = steep ? glm::dvec3(camera[1]) * (back.y > 0.0 ? -1.0 : 1.0) : back;
  azimuth_ = glm::degrees(std::atan2(level.x, level.z));
}

glm::dvec3 Navigation::towardsEye() const {
  const double a = glm::radians(azimuth_);
  const double e = glm::radians(elevation_);
  return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

void Navigation::orbit(double right, double up) {
  azimuth_ = std::remainder(azimuth_ + right, 360.0);
  elevation_ = std::clamp(elevation_ + up, -kSteepest, kSteepest);
}

void Navigation::pan(double right, double up) {
  const glm::dvec3 back = towardsEye();
  const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), back));
  const glm::dvec3 y = glm::cross(back, x);
  const double height = 2.0 * distance_ * std::tan(glm::radians(0.5 * fov_));
  target_ -= height * (right * x + up * y);
}

void Navigation::zoom(double factor) { distance_ = std::max(distance_ / factor, least_); }

void Navigation::put(CameraArguments& arguments, const glm::dvec3& origin) const {
  const glm::dmat3 fromScene = glm::transpose(turnOf(arguments.up)); // it only swaps coordinates
  arguments.camera.reset();
  arguments.orbit.reset();
  arguments.eye = fromScene * (target_ + distance_ * towardsEye() + origin);
  arguments.lookAt = fromScene * (target_ + origin);
  arguments.fov = static_cast<float>(fov_);
}

} // namespace vitrail::tool
