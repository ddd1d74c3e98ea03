// The camera in the user's hands: it goes around a point, towards it and past it, and stays upright.
#pragma once

#include "../commands/camera_options.h"
#include "../scene/camera.h"
#include "../scene/scene.h"

namespace vitrail::tool {

class Navigation {
 public:
  // Where moves begin: a view of a scene with that box.
  void begin(const Bounds& bounds, const View& view);

  // Around the point, in degrees, to the right and up.
  void orbit(double right, double up);
  // Along the picture, in parts of its height, to the right and up: what is under the mouse stays there.
  void pan(double right, double up);
  // Nearer to the point by this factor, above 0.
  void zoom(double factor);

  // Degrees; what an Orbit has that looks from here.
  [[nodiscard]] double azimuth() const { return azimuth_; }
  [[nodiscard]] double elevation() const { return elevation_; }

  // The camera as options say it, in the file's coordinates; `origin` is the scene's.
  void put(CameraArguments& arguments, const glm::dvec3& origin) const;

 private:
  [[nodiscard]] glm::dvec3 towardsEye() const;

  glm::dvec3 target_{0.0};
  double azimuth_ = 0.0;
  double elevation_ = 0.0;
  double distance_ = 1.0;
  double least_ = 1.0e-6; // distance
  double fov_ = 45.0;
};

} // namespace vitrail::tool
