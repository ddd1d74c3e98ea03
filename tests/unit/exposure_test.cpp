// How bright the lights of a scene are drawn: docs/shading.md, "Exposure".
#include <gtest/gtest.h>

#include "../../tool/scene/builtin/shapes.h"
#include "../../tool/scene/exposure.h"
#include "../reference/test_scenes.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;

Scene sheet(bool doubleSided = false) {
  Scene scene;
  Material material;
  material.doubleSided = doubleSided;
  addRectangle(scene, {glm::vec2(-0.001F), glm::vec2(0.001F), 0.0F}, material);
  return scene;
}

Light sun(float intensity, const glm::vec3& direction) {
  Light light;
  light.kind = Light::Kind::Directional;
  light.intensity = glm::vec3(intensity, 0.5F * intensity, 0.0F);
  light.direction = glm::normalize(direction);
  return light;
}

Light lamp(float intensity, const glm::vec3& position) {
  Light light;
  light.intensity = glm::vec3(intensity);
  light.position = position;
  return light;
}

TEST(Exposure, OneSunIsAsBrightAsTheToolsOwnLight) {
  for (const float intensity : {0.01F, 1.0F, 2000.0F}) {
    Scene scene = sheet();
    scene.lights = {sun(intensity, {0.5F, 0.2F, -1.0F})};
    EXPECT_NEAR(lightExposure(scene) * double{intensity}, 2.0, 1e-6);
    scene.meshes[0] = uvSphere(16, 8);
    EXPECT_NEAR(lightExposure(scene) * double{intensity}, 2.0, 1e-6);
  }
}

// Lights before a sheet add up, one behind it does not count unless its back is drawn.
TEST(Exposure, LightsAddUpOnTheSideThatTheyShineOn) {
  Scene scene = sheet();
  scene.lights = {sun(3.0F, {0.0F, 0.0F, -1.0F}), sun(5.0F, {0.3F, 0.0F, -1.0F}), sun(100.0F, {0.0F, 0.0F, 1.0F})};
  EXPECT_NEAR(lightExposure(scene), 2.0 / 8.0, 1e-6);
  scene.materials[0].doubleSided = true; // most of the light arrives there
  EXPECT_NEAR(lightExposure(scene), 2.0 / 100.0, 1e-6);
}

// Two metres away a quarter of the candela arrive; half way to the end of the range 15/16 of them.
TEST(Exposure, LampsFadeWithDistance) {
  Scene scene = sheet();
  scene.lights = {lamp(54351.0F, {0.0F, 0.0F, 2.0F})};
  EXPECT_NEAR(lightExposure(scene), 2.0 / (54351.0 / 4.0), 1e-6);
  scene.lights[0].range = 4.0F;
  EXPECT_NEAR(lightExposure(scene), 2.0 / (54351.0 / 4.0 * 15.0 / 16.0), 1e-9);
  scene.lights[0].kind = Light::Kind::Spot;
  scene.lights[0].innerConeAngle = 0.3F;
  EXPECT_NEAR(lightExposure(scene), 2.0 / (54351.0 / 4.0 * 15.0 / 16.0), 1e-9);
  scene.lights[0].direction = {0.0F, 1.0F, 0.0F}; // shines elsewhere
  EXPECT_EQ(lightExposure(scene), 1.0);
}

// A bulb round a lamp takes all of its light, and the room is not the darker for it.
TEST(Exposure, BulbsDoNotCount) {
  Scene scene = sheet();
  scene.draws[0].transform[0].x = scene.draws[0].transform[1].y = 2000.0F; // four by four metres
  scene.lights = {lamp(100.0F, {0.0F, 0.0F, 2.0F})};
  const double without = lightExposure(scene);
  Draw bulb;
  bulb.mesh = 1;
  bulb.transform[0].x = bulb.transform[1].y = bulb.transform[2].z = 0.02F;
  bulb.transform[3] = {0.0F, 0.0F, 2.0F, 1.0F};
  scene.meshes.push_back(uvSphere(32, 16));
  scene.draws.push_back(bulb);
  scene.materials[0].doubleSided = true;
  EXPECT_NEAR(lightExposure(scene) / without, 1.0, 0.2);
}

TEST(Exposure, NothingToLight) {
  Scene scene = sheet();
  EXPECT_EQ(lightExposure(scene), 1.0);
  scene.lights = {sun(7.0F, {0.0F, 0.0F, -1.0F})};
  scene.materials[0].unlit = true;
  EXPECT_EQ(lightExposure(scene), 1.0);
  scene.materials[0].unlit = false;
  scene.lights[0].direction = {0.0F, 0.0F, 1.0F};
  EXPECT_EQ(lightExposure(scene), 1.0);
}

} // namespace
} // namespace vitrail::tool::test
