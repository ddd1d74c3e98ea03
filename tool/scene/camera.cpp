// Views and their matrices. The fit is computed in double: a model may be tiny, huge or far from the origin.
#include "camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace vitrail::tool {
namespace {

constexpr double margin = 1.05;

// The orbiting camera's axes as columns: right, up, backward. Azimuth fixes "right" on its own, so that looking
// straight up or down is not special.
glm::dmat3 orbitAxes(const Orbit& orbit) {
  const double azimuth = glm::radians(static_cast<double>(orbit.azimuth));
  const double elevation = glm::radians(static_cast<double>(orbit.elevation));
  const glm::dvec3 right(std::cos(azimuth), 0.0, -std::sin(azimuth));
  const glm::dvec3 backward(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                            std::cos(azimuth) * std::cos(elevation));
  return {right, glm::cross(backward, right), backward};
}

// Finds the place of a camera from which all points are in the picture, in the camera's axes. A point (x, y, z) is left
// of the picture's right edge, for a camera at (cx, cy, cz), where x / slopeX + z <= cx / slopeX + cz, and alike for
// the other edges: the largest left-hand sides decide.
class Fit {
 public:
  Fit(const Orbit& orbit, float aspect)
      : axes_(orbitAxes(orbit)),
        slopeX_(std::tan(0.5 * glm::radians(static_cast<double>(orbit.fov))) * static_cast<double>(aspect)),
        slopeY_(std::tan(0.5 * glm::radians(static_cast<double>(orbit.fov)))) {}

  void add(const glm::dvec3& point) {
    const glm::dvec3 place = point * axes_; // a row vector: the transpose of axes, times the column
    const double x = place.x * margin / slopeX_;
    const double y = place.y * margin / slopeY_;
    right_ = std::max(right_, place.z + x);
    left_ = std::max(left_, place.z - x);
    up_ = std::max(up_, place.z + y);
    down_ = std::max(down_, place.z - y);
    nearest_ = std::max(nearest_, place.z);
    farthest_ = std::min(farthest_, place.z);
    remoteness_ = std::max({remoteness_, std::abs(place.x), std::abs(place.y), std::abs(place.z)});
  }

  View view(float zoom) {
    if (nearest_ == lowest) add(glm::dvec3(0.0)); // there is nothing: any place will do
    const double fitted = std::max(0.5 * (right_ + left_), 0.5 * (up_ + down_));
    // Lines along the view direction would fit from their own end, and a point has no size to fit. It is seen from a
    // distance that float can still tell from 0 where the point is.
    double size = fitted - farthest_;
    if (size <= 1e-6 * remoteness_ || size == 0.0) size = remoteness_ > 0.0 ? 1e-3 * remoteness_ : 1.0;
    const double distance = std::max(fitted, nearest_ + 0.05 * size);
    const glm::dvec3 eye(0.5 * (right_ - left_) * slopeX_ / margin, 0.5 * (up_ - down_) * slopeY_ / margin, distance);

    View view;
    for (int column = 0; column < 3; ++column) view.cameraToWorld[column] = glm::vec4(glm::vec3(axes_[column]), 0.0F);
    view.cameraToWorld[3] = glm::vec4(glm::vec3(axes_ * eye), 1.0F);
    view.verticalFov = static_cast<float>(2.0 * std::atan(slopeY_ / static_cast<double>(zoom)));
    view.nearPlane = static_cast<float>(0.5 * (distance - nearest_));
    view.farPlane = static_cast<float>(distance - farthest_ + 0.05 * size);
    return view;
  }

 private:
  static constexpr double lowest = std::numeric_limits<double>::lowest();

  glm::dmat3 axes_;
  double slopeX_;
  double slopeY_;
  double right_ = lowest;
  double left_ = lowest;
  double up_ = lowest;
  double down_ = lowest;
  double nearest_ = lowest;
  double farthest_ = -lowest;
  double remoteness_ = 0.0; // from the origin of the world
};

// A camera that looks at a place, as columns.
glm::dmat3 lookingAxes(const LookAt& look) {
  const glm::dvec3 backward = glm::normalize(look.eye - look.target);
  const double across = std::hypot(backward.x, backward.z);
  // Straight up or down "right" is where it is for an azimuth of 0.
  const glm::dvec3 right =
      across > 1e-9 ? glm::dvec3(backward.z, 0.0, -backward.x) / across : glm::dvec3(1.0, 0.0, 0.0);
  return {right, glm::cross(backward, right), backward};
}

// Finds the planes of a camera between which all points lie that it can see.
class Looking {
 public:
  explicit Looking(const LookAt& look) : look_(look), axes_(lookingAxes(look)) {}

  void add(const glm::dvec3& point) {
    const double distance = glm::dot(look_.eye - point, axes_[2]);
    nearest_ = std::min(nearest_, distance);
    farthest_ = std::max(farthest_, distance);
  }

  View view() {
    if (farthest_ < nearest_) add(look_.target); // there is nothing
    View view;
    for (int column = 0; column < 3; ++column) view.cameraToWorld[column] = glm::vec4(glm::vec3(axes_[column]), 0.0F);
    view.cameraToWorld[3] = glm::vec4(glm::vec3(look_.eye), 1.0F);
    view.verticalFov = glm::radians(look_.fov);
    // All may be behind the camera: some planes there must be.
    const double farthest = farthest_ > 0.0 ? farthest_ : glm::length(look_.eye - look_.target);
    // Inside the scene the near plane is where it cuts little away and depths are still apart.
    view.nearPlane = static_cast<float>(std::max(0.5 * nearest_, 1e-4 * farthest));
    view.farPlane = static_cast<float>(1.05 * farthest);
    return view;
  }

 private:
  LookAt look_;
  glm::dmat3 axes_;
  double nearest_ = std::numeric_limits<double>::max();
  double farthest_ = std::numeric_limits<double>::lowest();
};

} // namespace

View viewOf(const SceneCamera& camera) {
  View view;
  view.cameraToWorld = camera.cameraToWorld;
  view.orthographic = camera.orthographic;
  view.verticalFov = camera.verticalFov;
  view.halfHeight = camera.halfHeight;
  view.nearPlane = camera.nearPlane;
  view.farPlane = camera.farPlane.value_or(0.0F);
  return view;
}

View frameScene(const Scene& scene, const Orbit& orbit, float aspect) {
  Fit fit(orbit, aspect);
  visitPositions(scene, [&fit](std::span<const glm::vec3> positions) {
    for (const glm::vec3& position : positions) fit.add(glm::dvec3(position));
  });
  return fit.view(orbit.zoom);
}

View frameScene(const Bounds& bounds, const Orbit& orbit, float aspect) {
  Fit fit(orbit, aspect);
  for (unsigned i = 0; i < 8; ++i) {
    const glm::vec3 corner((i & 1U) != 0 ? bounds.max.x : bounds.min.x, (i & 2U) != 0 ? bounds.max.y : bounds.min.y,
                           (i & 4U) != 0 ? bounds.max.z : bounds.min.z);
    fit.add(glm::dvec3(corner));
  }
  return fit.view(orbit.zoom);
}

View frameScene(std::span<const glm::dvec3> points, const Orbit& orbit, float aspect) {
  Fit fit(orbit, aspect);
  for (const glm::dvec3& point : points) fit.add(point);
  return fit.view(orbit.zoom);
}

View lookFrom(const Scene& scene, const LookAt& look) {
  Looking looking(look);
  visitPositions(scene, [&looking](std::span<const glm::vec3> positions) {
    for (const glm::vec3& position : positions) looking.add(glm::dvec3(position));
  });
  return looking.view();
}

View lookFrom(std::span<const glm::dvec3> points, const LookAt& look) {
  Looking looking(look);
  for (const glm::dvec3& point : points) looking.add(point);
  return looking.view();
}

glm::mat4 viewMatrix(const View& view) { return glm::mat4(glm::inverse(glm::dmat4(view.cameraToWorld))); }

glm::mat4 projectionMatrix(const View& view, float aspect) {
  const double nearPlane = view.nearPlane;
  const double farPlane = view.farPlane;
  const double depth = farPlane - nearPlane;
  glm::dmat4 matrix(0.0);
  if (view.orthographic) {
    const double scale = 1.0 / static_cast<double>(view.halfHeight);
    matrix[0][0] = scale / static_cast<double>(aspect);
    matrix[1][1] = -scale;
    matrix[2][2] = 1.0 / depth;
    matrix[3][2] = farPlane / depth;
    matrix[3][3] = 1.0;
    return glm::mat4(matrix);
  }
  const double scale = 1.0 / std::tan(0.5 * static_cast<double>(view.verticalFov));
  const bool infinite = view.farPlane == 0.0F;
  matrix[0][0] = scale / static_cast<double>(aspect);
  matrix[1][1] = -scale;
  matrix[2][2] = infinite ? 0.0 : nearPlane / depth;
  matrix[2][3] = -1.0;
  matrix[3][2] = infinite ? nearPlane : farPlane / depth * nearPlane;
  return glm::mat4(matrix);
}

} // namespace vitrail::tool
