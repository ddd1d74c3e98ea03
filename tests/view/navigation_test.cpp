// The camera of a window: it begins where the view is, and goes where it is moved.
#include <gtest/gtest.h>

#include <array>

#include "scene/builtin/builtin.h"
#include "scene/turn.h"
#include "view/navigation.h"

namespace vitrail::tool {
namespace {

// As `render` takes what navigation puts into the options.
View viewed(const Navigation& navigation, const Scene& scene, UpAxis up = UpAxis::Y) {
  CameraArguments arguments;
  arguments.up = up;
  navigation.put(arguments, scene.origin);
  LookAt look;
  look.eye = turnOf(up) * *arguments.eye - scene.origin;
  look.target = turnOf(up) * *arguments.lookAt - scene.origin;
  look.fov = *arguments.fov;
  return lookFrom(scene, look);
}

double difference(const View& a, const View& b) {
  double most = std::abs(static_cast<double>(a.verticalFov) - static_cast<double>(b.verticalFov));
  for (int column = 0; column < 4; ++column) {
    most = std::max(most, glm::length(glm::dvec4(a.cameraToWorld[column]) - glm::dvec4(b.cameraToWorld[column])));
  }
  return most;
}

TEST(Navigation, BeginsWhereTheViewIs) {
  Scene scene = makeBuiltinScene("interlocked", {});
  scene.origin = {100.0, -20.0, 7.0};
  for (const Orbit& orbit : {Orbit{}, Orbit{-120.0F, -40.0F, 1.0F}, Orbit{0.0F, 0.0F, 2.5F}, Orbit{170.0F, 80.0F, 0.4F},
                             Orbit{35.0F, 20.0F, 1.0F, 70.0F}}) {
    SCOPED_TRACE(std::to_string(orbit.azimuth));
    const View view = frameScene(scene, orbit, 1.6F);
    Navigation navigation;
    navigation.begin(worldBounds(scene), view);
    EXPECT_LT(difference(viewed(navigation, scene), view), 1.0e-4);
    EXPECT_LT(difference(viewed(navigation, scene, UpAxis::Z), view), 1.0e-4);
    EXPECT_NEAR(navigation.azimuth(), orbit.azimuth, 1.0e-3);
    EXPECT_NEAR(navigation.elevation(), orbit.elevation, 1.0e-3);
  }
}

// From straight above the picture turns by half a degree at most, and keeps its sides.
TEST(Navigation, BeginsFromAbove) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  for (const float elevation : {90.0F, -90.0F}) {
    for (const float azimuth : {0.0F, 50.0F}) {
      const View view = frameScene(scene, Orbit{azimuth, elevation, 1.0F}, 1.6F);
      Navigation navigation;
      navigation.begin(worldBounds(scene), view);
      const View begun = viewed(navigation, scene);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GT(glm::dot(glm::vec3(begun.cameraToWorld[axis]), glm::vec3(view.cameraToWorld[axis])), 0.999F)
            << elevation << ", " << azimuth << ", axis " << axis;
      }
    }
  }
}

TEST(Navigation, MovesAsItIsTold) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  Navigation navigation;
  navigation.begin(worldBounds(scene), frameScene(scene, Orbit{10.0F, 20.0F, 1.0F}, 1.0F));
  const View before = viewed(navigation, scene);
  navigation.orbit(30.0, -15.0);
  EXPECT_NEAR(navigation.azimuth(), 40.0, 1.0e-3);
  EXPECT_NEAR(navigation.elevation(), 5.0, 1.0e-3);
  navigation.orbit(-30.0, 15.0);
  EXPECT_LT(difference(viewed(navigation, scene), before), 1.0e-4);
  // What is in the middle of the picture is half a picture lower after a pan of half a picture down.
  CameraArguments arguments;
  navigation.put(arguments, scene.origin);
  const glm::dvec3 middle = *arguments.lookAt;
  navigation.pan(0.25, -0.5);
  const View panned = viewed(navigation, scene);
  const glm::vec4 clip = projectionMatrix(panned, 1.0F) * viewMatrix(panned) * glm::vec4(glm::vec3(middle), 1.0F);
  EXPECT_NEAR(clip.x / clip.w, 0.5F, 1.0e-4F);
  EXPECT_NEAR(clip.y / clip.w, 1.0F, 1.0e-4F); // Vulkan's y points down
  navigation.pan(-0.25, 0.5);
  navigation.zoom(2.0);
  navigation.put(arguments, scene.origin);
  const double near = glm::length(*arguments.eye - *arguments.lookAt);
  navigation.zoom(0.5);
  navigation.put(arguments, scene.origin);
  EXPECT_NEAR(glm::length(*arguments.eye - *arguments.lookAt), 2.0 * near, 1.0e-9);
  navigation.orbit(0.0, 1000.0);
  EXPECT_LT(navigation.elevation(), 90.0);
}

} // namespace
} // namespace vitrail::tool
