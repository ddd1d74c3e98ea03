// Where models stand: turned upright, several in one scene, looked at from a place, turned before the camera.
#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin/shapes.h"
#include "scene/camera.h"
#include "scene/merge.h"
#include "scene/turn.h"
#include "scene/turntable.h"

namespace vitrail::tool::test {
namespace {

// A sphere of radius 1 at a place, with a material of its own.
Scene sphereAt(const glm::vec3& place) {
  Scene scene;
  scene.meshes.push_back(uvSphere(24, 12));
  scene.images.resize(1);
  scene.materials.emplace_back();
  scene.materials.back().baseColorTexture.image = 0;
  scene.draws.push_back({0, 0, glm::translate(glm::mat4(1.0F), place)});
  return scene;
}

glm::vec3 placeOf(const Draw& draw) { return glm::vec3(draw.transform[3]); }

TEST(Turn, TheUpAxisOfTheFileBecomesY) {
  EXPECT_EQ(turnOf(UpAxis::Z) * glm::dvec3(0, 0, 1), glm::dvec3(0, 1, 0));
  EXPECT_EQ(turnOf(UpAxis::Z) * glm::dvec3(1, 0, 0), glm::dvec3(1, 0, 0));
  EXPECT_EQ(turnOf(UpAxis::X) * glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0));
  EXPECT_EQ(turnOf(UpAxis::X) * glm::dvec3(0, 0, 1), glm::dvec3(0, 0, 1));
  EXPECT_EQ(turnOf(UpAxis::Y), glm::dmat3(1.0));
  for (const UpAxis up : {UpAxis::Z, UpAxis::X}) EXPECT_EQ(glm::determinant(turnOf(up)), 1.0);
}

TEST(Turn, AllThatIsInAScene) {
  Scene scene = sphereAt({1.0F, 2.0F, 3.0F});
  scene.origin = {10.0, 20.0, 30.0};
  scene.cameras.emplace_back();
  scene.cameras.back().cameraToWorld[3] = glm::vec4(4.0F, 5.0F, 6.0F, 1.0F);
  scene.lights.emplace_back();
  scene.lights.back().position = {7.0F, 8.0F, 9.0F};
  scene.lights.back().direction = {0.0F, 0.0F, -1.0F};
  turnScene(scene, UpAxis::Z);
  EXPECT_EQ(placeOf(scene.draws[0]), glm::vec3(1.0F, 3.0F, -2.0F));
  EXPECT_EQ(scene.origin, glm::dvec3(10.0, 30.0, -20.0));
  EXPECT_EQ(glm::vec3(scene.cameras[0].cameraToWorld[3]), glm::vec3(4.0F, 6.0F, -5.0F));
  EXPECT_EQ(glm::vec3(scene.cameras[0].cameraToWorld[2]), glm::vec3(0.0F, 1.0F, 0.0F)); // it looked down
  EXPECT_EQ(scene.lights[0].position, glm::vec3(7.0F, 9.0F, -8.0F));
  EXPECT_EQ(scene.lights[0].direction, glm::vec3(0.0F, -1.0F, 0.0F));
}

TEST(Merge, EveryModelKeepsItsOwnMeshesMaterialsAndImages) {
  std::vector<Scene> scenes{sphereAt({1.0F, 0.0F, 0.0F}), sphereAt({2.0F, 0.0F, 0.0F})};
  scenes[0].warnings = {"one"};
  scenes[1].warnings = {"two"};
  scenes[1].materials[0].clearcoatTexture.image = 0;
  const Scene merged = mergeScenes(std::move(scenes), {"a.glb", "b.obj"});
  ASSERT_EQ(merged.draws.size(), 2U);
  EXPECT_EQ(merged.draws[1].mesh, 1U);
  EXPECT_EQ(merged.draws[1].material, 1U);
  EXPECT_EQ(merged.materials[0].baseColorTexture.image, 0);
  EXPECT_EQ(merged.materials[1].baseColorTexture.image, 1);
  EXPECT_EQ(merged.materials[1].clearcoatTexture.image, 1);
  EXPECT_EQ(merged.materials[1].normalTexture.image, -1);
  EXPECT_EQ(merged.images.size(), 2U);
  EXPECT_EQ(merged.warnings, (std::vector<std::string>{"a.glb: one", "b.obj: two"}));
}

TEST(Merge, OriginsDifferInDoublePrecision) {
  std::vector<Scene> scenes{sphereAt({0.0F, 0.0F, 0.0F}), sphereAt({0.5F, 0.0F, 0.0F})};
  scenes[0].origin = {4'649'776.25, 100.0, 0.0};
  scenes[1].origin = {4'649'777.5, 100.0, 0.125};
  scenes[1].cameras.emplace_back();
  scenes[1].lights.emplace_back();
  const Scene merged = mergeScenes(std::move(scenes), {"a", "b"});
  EXPECT_EQ(merged.origin, glm::dvec3(4'649'776.25, 100.0, 0.0));
  EXPECT_EQ(placeOf(merged.draws[1]), glm::vec3(1.75F, 0.0F, 0.125F));
  EXPECT_EQ(glm::vec3(merged.cameras[0].cameraToWorld[3]), glm::vec3(1.25F, 0.0F, 0.125F));
  EXPECT_EQ(merged.lights[0].position, glm::vec3(1.25F, 0.0F, 0.125F));
}

TEST(Merge, OneModelStaysAsItIs) {
  std::vector<Scene> scenes{sphereAt({0.0F, 0.0F, 0.0F})};
  scenes[0].warnings = {"one"};
  EXPECT_EQ(mergeScenes(std::move(scenes), {"a.glb"}).warnings, std::vector<std::string>{"one"});
}

glm::vec2 onScreen(const View& view, float aspect, const glm::vec3& place) {
  const glm::vec4 clip = projectionMatrix(view, aspect) * viewMatrix(view) * glm::vec4(place, 1.0F);
  return glm::vec2(clip) / clip.w;
}

TEST(LookFrom, TheTargetIsInTheMiddleAndThePictureIsUpright) {
  const Scene scene = sphereAt({1.0F, 2.0F, 3.0F});
  const View view = lookFrom(scene, {{9.0, 4.0, -2.0}, {1.0, 2.0, 3.0}, 60.0F});
  const glm::vec2 middle = onScreen(view, 1.5F, {1.0F, 2.0F, 3.0F});
  EXPECT_NEAR(middle.x, 0.0F, 1e-5F);
  EXPECT_NEAR(middle.y, 0.0F, 1e-5F);
  const glm::vec2 above = onScreen(view, 1.5F, {1.0F, 2.5F, 3.0F});
  EXPECT_NEAR(above.x, 0.0F, 1e-5F);
  EXPECT_LT(above.y, -0.01F); // y is down
  EXPECT_NEAR(view.verticalFov, glm::radians(60.0F), 1e-6F);
  const float distance = std::sqrt(64.0F + 4.0F + 25.0F);
  EXPECT_LT(view.nearPlane, distance - 1.0F);
  EXPECT_GT(view.nearPlane, 0.3F * distance);
  EXPECT_GT(view.farPlane, distance + 1.0F);
}

TEST(LookFrom, StraightDownIsAsAnOrbitOf90Degrees) {
  const Scene scene = sphereAt({0.0F, 0.0F, 0.0F});
  const glm::mat4 down = lookFrom(scene, {{0.0, 5.0, 0.0}, {0.0, 0.0, 0.0}, 45.0F}).cameraToWorld;
  const glm::mat4 orbit = frameScene(scene, {0.0F, 90.0F, 1.0F}, 1.0F).cameraToWorld;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) EXPECT_NEAR(down[column][row], orbit[column][row], 1e-6F);
  }
}

TEST(LookFrom, InsideTheSceneTheNearPlaneIsClose) {
  const View view = lookFrom(sphereAt({0.0F, 0.0F, 0.0F}), {{0.0, 0.0, 0.5}, {0.0, 0.0, 0.0}, 45.0F});
  EXPECT_GT(view.nearPlane, 0.0F);
  EXPECT_LT(view.nearPlane, 0.001F);
  EXPECT_GT(view.farPlane, 1.5F);
}

TEST(Orbit, AWiderFieldOfViewIsNearer) {
  const Scene scene = sphereAt({0.0F, 0.0F, 0.0F});
  Orbit wide{0.0F, 0.0F, 1.0F};
  wide.fov = 90.0F;
  const View usual = frameScene(scene, {0.0F, 0.0F, 1.0F}, 1.0F);
  const View view = frameScene(scene, wide, 1.0F);
  EXPECT_NEAR(view.verticalFov, glm::radians(90.0F), 1e-6F);
  EXPECT_LT(view.cameraToWorld[3].z, 0.7F * usual.cameraToWorld[3].z);
  EXPECT_GT(view.cameraToWorld[3].z, 1.0F);
}

// A long box: it fills pictures from the side and is narrow from its end.
Scene longBox() {
  Scene scene = sphereAt({0.0F, 0.0F, 0.0F});
  scene.draws[0].transform =
      glm::translate(glm::mat4(1.0F), {5.0F, 1.0F, -2.0F}) * glm::scale(glm::mat4(1.0F), {4.0F, 1.0F, 0.5F});
  return scene;
}

TEST(Turntable, TheWholeModelIsInEveryPictureFromOneDistance) {
  const Scene scene = longBox();
  const glm::vec3 middle(5.0F, 1.0F, -2.0F);
  const std::vector<View> views = turntable(scene, {20.0F, 30.0F, 1.0F}, 1.5F, 36);
  ASSERT_EQ(views.size(), 36U);
  float largest = 0.0F;
  for (const View& view : views) {
    EXPECT_NEAR(glm::distance(glm::vec3(view.cameraToWorld[3]), middle),
                glm::distance(glm::vec3(views[0].cameraToWorld[3]), middle), 1e-4F);
    visitPositions(scene, [&](std::span<const glm::vec3> positions) {
      for (const glm::vec3& position : positions) {
        const glm::vec2 place = onScreen(view, 1.5F, position);
        largest = std::max({largest, std::abs(place.x), std::abs(place.y)});
        const float depth = -(viewMatrix(view) * glm::vec4(position, 1.0F)).z;
        EXPECT_TRUE(depth > view.nearPlane && depth < view.farPlane) << depth;
      }
    });
  }
  EXPECT_LE(largest, 1.0F);
  EXPECT_GT(largest, 0.85F);
}

TEST(Turntable, ItBeginsAtTheOrbitAndGoesToTheRight) {
  const std::vector<View> views = turntable(longBox(), {20.0F, 30.0F, 1.0F}, 1.5F, 4);
  for (std::size_t i = 0; i < views.size(); ++i) {
    Orbit orbit{20.0F + 90.0F * static_cast<float>(i), 30.0F, 1.0F};
    const glm::mat4 expected = frameScene(longBox(), orbit, 1.5F).cameraToWorld;
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) {
        EXPECT_NEAR(views[i].cameraToWorld[column][row], expected[column][row], 1e-5F) << i;
      }
    }
  }
}

TEST(Turntable, FromAPlaceItGoesAroundWhatIsLookedAt) {
  const std::vector<View> views = turntable(longBox(), {{8.0, 3.0, 10.0}, {5.0, 1.0, -2.0}, 50.0F}, 2);
  EXPECT_NEAR(views[0].cameraToWorld[3].x, 8.0F, 1e-5F);
  EXPECT_NEAR(views[1].cameraToWorld[3].x, 2.0F, 1e-5F); // the other side
  EXPECT_NEAR(views[1].cameraToWorld[3].y, 3.0F, 1e-5F);
  EXPECT_NEAR(views[1].cameraToWorld[3].z, -14.0F, 1e-5F);
  const glm::vec2 middle = onScreen(views[1], 1.0F, {5.0F, 1.0F, -2.0F});
  EXPECT_NEAR(glm::length(middle), 0.0F, 1e-5F);
}

} // namespace
} // namespace vitrail::tool::test
