// Framing and projection: the whole scene is in the picture, and depth is reversed.
#include "scene/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin/shapes.h"

namespace vitrail::tool::test {
namespace {

glm::vec3 corner(const Bounds& bounds, unsigned i) {
  return {(i & 1U) != 0 ? bounds.max.x : bounds.min.x, (i & 2U) != 0 ? bounds.max.y : bounds.min.y,
          (i & 4U) != 0 ? bounds.max.z : bounds.min.z};
}

// What a box covers of clip space, after the division by w.
struct Covered {
  glm::vec3 min{std::numeric_limits<float>::max()};
  glm::vec3 max{std::numeric_limits<float>::lowest()};
  bool inFront = true;
};

Covered cover(const Bounds& bounds, const View& view, float aspect) {
  const glm::mat4 clip = projectionMatrix(view, aspect) * viewMatrix(view);
  Covered covered;
  for (unsigned i = 0; i < 8; ++i) {
    const glm::vec4 point = clip * glm::vec4(corner(bounds, i), 1.0F);
    covered.inFront = covered.inFront && point.w > 0.0F;
    covered.min = glm::min(covered.min, glm::vec3(point) / point.w);
    covered.max = glm::max(covered.max, glm::vec3(point) / point.w);
  }
  return covered;
}

bool isFinite(const glm::mat4& matrix) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(matrix[column][row])) return false;
    }
  }
  return true;
}

template <typename Check>
void forManyViews(Check check) {
  for (const float aspect : {0.1F, 0.5F, 1.0F, 16.0F / 9.0F, 8.0F}) {
    for (const float azimuth : {-170.0F, 0.0F, 35.0F, 90.0F, 275.0F}) {
      for (const float elevation : {-90.0F, -40.0F, 0.0F, 20.0F, 90.0F}) check(aspect, azimuth, elevation);
    }
  }
}

TEST(Camera, FramesTheWholeBox) {
  for (const Bounds& bounds :
       {Bounds{glm::vec3(-1.0F), glm::vec3(1.0F)}, Bounds{{-1.0F, -8.0F, -0.1F}, {1.0F, 8.0F, 0.1F}},
        Bounds{{100.0F, 200.0F, -50.0F}, {101.0F, 203.0F, -49.5F}}, Bounds{glm::vec3(-1e-3F), glm::vec3(1e-3F)},
        Bounds{glm::vec3(-1e6F), glm::vec3(2e6F)}, Bounds{{-1.0F, 0.0F, -1.0F}, {1.0F, 0.0F, 2.0F}}}) {
    forManyViews([&bounds](float aspect, float azimuth, float elevation) {
      const Covered covered = cover(bounds, frameScene(bounds, {azimuth, elevation, 1.0F}, aspect), aspect);
      EXPECT_TRUE(covered.inFront);
      EXPECT_LE(std::max(covered.max.x, -covered.min.x), 1.0F);
      EXPECT_LE(std::max(covered.max.y, -covered.min.y), 1.0F);
      EXPECT_GT(covered.min.z, 0.0F);
      EXPECT_LT(covered.max.z, 1.0F);
    });
  }
}

// In the direction that decides, both sides come as near to the border as the margin lets them.
TEST(Camera, FramesTightly) {
  const Bounds bounds{{-1.0F, -0.5F, -2.0F}, {1.0F, 0.5F, 1.0F}};
  forManyViews([&bounds](float aspect, float azimuth, float elevation) {
    const Covered covered = cover(bounds, frameScene(bounds, {azimuth, elevation, 1.0F}, aspect), aspect);
    const float across = std::min(covered.max.x, -covered.min.x);
    const float up = std::min(covered.max.y, -covered.min.y);
    EXPECT_NEAR(std::max(across, up), 1.0F / 1.05F, 0.002F);
  });
}

TEST(Camera, FramesTheGeometryTighterThanItsBox) {
  Scene scene;
  scene.meshes.push_back(uvSphere(64, 32));
  scene.materials.emplace_back();
  scene.draws.push_back({0, 0, glm::translate(glm::mat4(1.0F), glm::vec3(3.0F, -4.0F, 5.0F))});
  const View view = frameScene(scene, Orbit{}, 1.5F);
  const float distance = glm::distance(glm::vec3(view.cameraToWorld[3]), glm::vec3(3.0F, -4.0F, 5.0F));
  // A unit sphere fits between lines of slope tan(22.5 degrees) / 1.05 from 1 / sin(their angle).
  EXPECT_NEAR(distance, 1.0 / std::sin(std::atan(std::tan(0.785398 / 2.0) / 1.05)), 0.01);
  EXPECT_NEAR(view.verticalFov, 0.785398F, 1e-5F);
}

TEST(Camera, LooksFromWhereTheOrbitSays) {
  const Bounds bounds{glm::vec3(-1.0F), glm::vec3(1.0F)};
  const auto backward = [&bounds](float azimuth, float elevation) {
    return glm::vec3(frameScene(bounds, {azimuth, elevation, 1.0F}, 1.0F).cameraToWorld[2]);
  };
  EXPECT_LT(glm::distance(backward(0.0F, 0.0F), glm::vec3(0.0F, 0.0F, 1.0F)), 1e-6F);
  EXPECT_LT(glm::distance(backward(90.0F, 0.0F), glm::vec3(1.0F, 0.0F, 0.0F)), 1e-6F);
  EXPECT_LT(glm::distance(backward(0.0F, 90.0F), glm::vec3(0.0F, 1.0F, 0.0F)), 1e-6F);
  EXPECT_LT(glm::distance(backward(123.0F, -90.0F), glm::vec3(0.0F, -1.0F, 0.0F)), 1e-6F);
}

TEST(Camera, ViewsAreRotationsAndTranslations) {
  forManyViews([](float aspect, float azimuth, float elevation) {
    const Bounds bounds{glm::vec3(-1.0F), glm::vec3(1.0F)};
    const glm::mat3 axes(frameScene(bounds, {azimuth, elevation, 1.0F}, aspect).cameraToWorld);
    EXPECT_NEAR(glm::determinant(axes), 1.0F, 1e-5F);
    EXPECT_LT(glm::distance(glm::transpose(axes) * axes * glm::vec3(1.0F), glm::vec3(1.0F)), 1e-5F);
  });
}

TEST(Camera, ZoomMagnifiesAndCutsNothing) {
  const Bounds bounds{glm::vec3(-1.0F), glm::vec3(1.0F)};
  const Covered once = cover(bounds, frameScene(bounds, {35.0F, 20.0F, 1.0F}, 1.5F), 1.5F);
  for (const float zoom : {0.25F, 2.0F, 3.0F, 20.0F}) {
    const Covered zoomed = cover(bounds, frameScene(bounds, {35.0F, 20.0F, zoom}, 1.5F), 1.5F);
    EXPECT_NEAR(zoomed.max.x, zoom * once.max.x, 1e-4F * zoom);
    EXPECT_NEAR(zoomed.min.y, zoom * once.min.y, 1e-4F * zoom);
    EXPECT_GT(zoomed.min.z, 0.0F);
    EXPECT_LT(zoomed.max.z, 1.0F);
  }
}

TEST(Camera, FlatAndEmptyBoundsGiveAView) {
  for (const Bounds& bounds :
       {Bounds{}, Bounds{glm::vec3(5.0F), glm::vec3(5.0F)}, Bounds{glm::vec3(-1e7F), glm::vec3(-1e7F)},
        Bounds{{0.0F, 0.0F, -1.0F}, {0.0F, 0.0F, 1.0F}}, Bounds{{0.0F, -3.0F, 0.0F}, {0.0F, 3.0F, 0.0F}}}) {
    forManyViews([&bounds](float aspect, float azimuth, float elevation) {
      const View view = frameScene(bounds, {azimuth, elevation, 1.0F}, aspect);
      EXPECT_TRUE(isFinite(view.cameraToWorld));
      EXPECT_GT(view.nearPlane, 0.0F);
      EXPECT_GT(view.farPlane, view.nearPlane);
      const Covered covered = cover(bounds, view, aspect);
      EXPECT_TRUE(covered.inFront);
      EXPECT_LE(std::max(covered.max.x, -covered.min.x), 1.0F);
      EXPECT_LE(std::max(covered.max.y, -covered.min.y), 1.0F);
      EXPECT_GT(covered.min.z, 0.0F);
      EXPECT_LT(covered.max.z, 1.0F);
    });
  }
}

// A point in camera space, after projection.
glm::vec3 project(const View& view, float aspect, const glm::vec3& point) {
  const glm::vec4 clip = projectionMatrix(view, aspect) * glm::vec4(point, 1.0F);
  return glm::vec3(clip) / clip.w;
}

TEST(Camera, PerspectiveReversesDepthAndPointsDown) {
  View view;
  view.nearPlane = 0.5F;
  view.farPlane = 20.0F;
  EXPECT_NEAR(project(view, 1.0F, {0.0F, 0.0F, -0.5F}).z, 1.0F, 1e-6F);
  EXPECT_NEAR(project(view, 1.0F, {0.0F, 0.0F, -20.0F}).z, 0.0F, 1e-6F);
  const float edge = std::tan(0.5F * view.verticalFov) * 3.0F;
  EXPECT_NEAR(project(view, 2.0F, {0.0F, edge, -3.0F}).y, -1.0F, 1e-6F);
  EXPECT_NEAR(project(view, 2.0F, {2.0F * edge, 0.0F, -3.0F}).x, 1.0F, 1e-6F);
}

TEST(Camera, InfinitePerspectiveEndsAtZero) {
  View view;
  view.nearPlane = 0.5F;
  EXPECT_NEAR(project(view, 1.0F, {0.0F, 0.0F, -0.5F}).z, 1.0F, 1e-6F);
  EXPECT_NEAR(project(view, 1.0F, {0.0F, 0.0F, -5.0F}).z, 0.1F, 1e-6F);
  const float distant = project(view, 1.0F, {0.0F, 0.0F, -1e9F}).z;
  EXPECT_GT(distant, 0.0F);
  EXPECT_LT(distant, 1e-8F);
}

TEST(Camera, OrthographicReversesDepthAndPointsDown) {
  View view;
  view.orthographic = true;
  view.halfHeight = 2.0F;
  view.nearPlane = 0.0F;
  view.farPlane = 10.0F;
  EXPECT_NEAR(project(view, 1.5F, {0.0F, 0.0F, 0.0F}).z, 1.0F, 1e-6F);
  EXPECT_NEAR(project(view, 1.5F, {0.0F, 0.0F, -10.0F}).z, 0.0F, 1e-6F);
  EXPECT_NEAR(project(view, 1.5F, {3.0F, 2.0F, -5.0F}).x, 1.0F, 1e-6F);
  EXPECT_NEAR(project(view, 1.5F, {3.0F, 2.0F, -5.0F}).y, -1.0F, 1e-6F);
}

TEST(Camera, ViewOfKeepsTheCameraOfTheFile) {
  SceneCamera camera;
  camera.cameraToWorld = glm::translate(glm::mat4(1.0F), glm::vec3(1.0F, 2.0F, 3.0F));
  camera.verticalFov = 0.5F;
  camera.nearPlane = 0.25F;
  View view = viewOf(camera);
  EXPECT_EQ(view.cameraToWorld, camera.cameraToWorld);
  EXPECT_FALSE(view.orthographic);
  EXPECT_EQ(view.verticalFov, 0.5F);
  EXPECT_EQ(view.nearPlane, 0.25F);
  EXPECT_EQ(view.farPlane, 0.0F);
  EXPECT_EQ(glm::vec3(viewMatrix(view) * glm::vec4(1.0F, 2.0F, 3.0F, 1.0F)), glm::vec3(0.0F));
  camera.orthographic = true;
  camera.halfHeight = 7.0F;
  camera.farPlane = 9.0F;
  view = viewOf(camera);
  EXPECT_TRUE(view.orthographic);
  EXPECT_EQ(view.halfHeight, 7.0F);
  EXPECT_EQ(view.farPlane, 9.0F);
}

} // namespace
} // namespace vitrail::tool::test
