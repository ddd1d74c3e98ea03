// Why a picture shows nothing of its scene.
#include "scene/visibility.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "reference/test_scenes.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::straightView;
using reference::unlitMaterial;

Seen straight(const View& view = straightView()) { return {view, 64, 64, {}}; }

std::string why(const Scene& scene, const Seen& seen = straight()) {
  return whyNothingIsSeen(scene, seen).value_or("nothing");
}

Scene quadOf(const Material& material) {
  Scene scene;
  addRectangle(scene, {}, material);
  return scene;
}

Material opaque() { return unlitMaterial(glm::vec4(1.0F), AlphaMode::Opaque); }

// Turns a draw round, so that its back is seen.
void turnRound(Scene& scene) {
  scene.draws[0].transform = glm::rotate(glm::mat4(1.0F), glm::radians(180.0F), glm::vec3(0.0F, 1.0F, 0.0F));
}

TEST(Visibility, WhatIsSeenHasNoReason) { EXPECT_EQ(why(quadOf(opaque())), "nothing"); }

TEST(Visibility, SingleSidedFromBehind) {
  Scene scene = quadOf(opaque());
  turnRound(scene);
  EXPECT_EQ(why(scene), "its surfaces are single-sided and face away from the camera");
  Seen xray = straight();
  xray.opacity = 0.5F;
  EXPECT_EQ(why(scene, xray), "nothing"); // transparent surfaces have two sides
  scene.materials[0].doubleSided = true;
  EXPECT_EQ(why(scene), "nothing");
}

TEST(Visibility, AMirrorTurnsSidesRound) {
  Scene scene = quadOf(opaque());
  scene.draws[0].transform = glm::scale(glm::mat4(1.0F), glm::vec3(-1.0F, 1.0F, 1.0F));
  EXPECT_EQ(why(scene), "nothing"); // glTF means the side that was outside before
  turnRound(scene);
  scene.draws[0].transform = scene.draws[0].transform * glm::scale(glm::mat4(1.0F), glm::vec3(-1.0F, 1.0F, 1.0F));
  EXPECT_EQ(why(scene), "its surfaces are single-sided and face away from the camera");
}

TEST(Visibility, AlphaOfMaterialsVerticesAndTextures) {
  const char* const reason = "all of it is wholly transparent (alpha 0)";
  EXPECT_EQ(why(quadOf(unlitMaterial(glm::vec4(1.0F, 1.0F, 1.0F, 0.0F)))), reason);
  EXPECT_EQ(why(quadOf(unlitMaterial(glm::vec4(1.0F, 1.0F, 1.0F, 0.4F), AlphaMode::Mask))), reason);
  EXPECT_EQ(why(quadOf(unlitMaterial(glm::vec4(1.0F, 1.0F, 1.0F, 0.0F), AlphaMode::Opaque))), "nothing");

  Scene vertices = quadOf(unlitMaterial(glm::vec4(1.0F)));
  reference::changeVertices(vertices.meshes[0], [](Vertex& vertex) { vertex.color.a = 0.0F; });
  EXPECT_EQ(why(vertices), reason);
  Vertex seen = vertices.meshes[0].vertex(2);
  seen.color.a = 0.5F;
  vertices.meshes[0].set(2, seen);
  EXPECT_EQ(why(vertices), "nothing");

  Scene texture = quadOf(unlitMaterial(glm::vec4(1.0F)));
  texture.images.push_back({2, 1, {9, 9, 9, 0, 9, 9, 9, 0}});
  texture.materials[0].baseColorTexture.image = 0;
  EXPECT_EQ(why(texture), reason);
  texture.images[0].rgba[7] = 1;
  EXPECT_EQ(why(texture), "nothing");
}

TEST(Visibility, TheCameraLooksElsewhere) {
  Scene scene = quadOf(opaque());
  View view = reference::wideView(); // from the origin along -Z
  const auto at = [&](const glm::vec3& place) {
    scene.draws[0].transform = glm::translate(glm::mat4(1.0F), place);
    return why(scene, straight(view));
  };
  EXPECT_EQ(at({0.0F, 0.0F, -3.0F}), "nothing");
  EXPECT_EQ(at({0.0F, 0.0F, 3.0F}), "it lies behind the camera");
  EXPECT_EQ(at({9.0F, 0.0F, -3.0F}), "the camera looks elsewhere");
  EXPECT_EQ(at({0.0F, 0.0F, -0.25F}), "it lies nearer than the camera's near plane");
  view.farPlane = 2.0F;
  EXPECT_EQ(at({0.0F, 0.0F, -3.0F}), "it lies beyond the camera's far plane");
}

TEST(Visibility, ClipPlanesCutItAway) {
  Scene scene = quadOf(opaque());
  scene.clipPlanes = {{1.0, 0.0, 0.0, 0.5}};
  EXPECT_EQ(why(scene), "nothing");
  scene.clipPlanes = {{1.0, 0.0, 0.0, 1.5}};
  EXPECT_EQ(why(scene), "the clip planes cut all of it away");
}

TEST(Visibility, SmallerThanAPixelIsAReasonWhereThePictureIsEmpty) {
  Scene scene = quadOf(opaque());
  scene.draws[0].transform = glm::scale(glm::mat4(1.0F), glm::vec3(0.001F));
  EXPECT_EQ(why(scene), "nothing"); // it may cover the middle of a pixel
  const std::string small = "nothing of the model is seen: it is smaller than a pixel";
  EXPECT_EQ(nothingSeenWarning(scene, straight()), small);
  scene.meshes[0].primitive = Primitive::Points; // each of which is a pixel wide
  EXPECT_NE(nothingSeenWarning(scene, straight()), small);
}

TEST(Visibility, TheWarningAlwaysHasAReason) {
  EXPECT_EQ(nothingSeenWarning(quadOf(opaque()), straight()),
            "nothing of the model is seen: it is too faint, too thin or of the background's colour");
}

} // namespace
} // namespace vitrail::tool::test
