// The pose that a glTF file's animations give at a time. The values are worked out by hand.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "load_good.h"
#include "scene/load.h"

namespace vitrail::tool {
namespace {

const float halfRoot = std::sqrt(0.5F);

LoadOptions at(double time) {
  LoadOptions options;
  options.time = time;
  return options;
}

LoadOptions animation(const std::string& name) {
  LoadOptions options;
  options.animation = name;
  return options;
}

glm::vec3 originOf(const Scene& scene, std::size_t draw) { return glm::vec3(placed(scene, draw, {})); }

TEST(GltfAnimation, WithoutATimeTheRestPoseIsDrawn) {
  const Scene scene = loadGood("animations.gltf");
  expectNear(originOf(scene, 0), {0.0F, 0.0F, 0.0F});
  expectNear(originOf(scene, 1), {0.0F, 0.0F, 7.0F});
  // The matrix turns x to y and doubles it, and y to -x and triples it.
  expectNear(placed(scene, 2, {1.0F, 0.0F, 0.0F}), {5.0F, 8.0F, 7.0F});
  expectNear(placed(scene, 2, {0.0F, 1.0F, 0.0F}), {2.0F, 6.0F, 7.0F});
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfAnimation, LinearValuesAreMixed) {
  const Scene scene = loadGood("animations.gltf", at(2.0));
  expectNear(originOf(scene, 0), {2.0F, 0.0F, 0.0F});
}

TEST(GltfAnimation, RotationsTakeTheShortWayAtAnEvenSpeed) {
  const Scene scene = loadGood("animations.gltf", at(2.0));
  // Half of a quarter turn, and the translation that is not animated stays.
  expectNear(placed(scene, 1, {1.0F, 0.0F, 0.0F}), {halfRoot, halfRoot, 7.0F}, 1e-4F);
  // A quarter of the way.
  const float angle = std::acos(-1.0F) / 8.0F;
  const Scene earlier = loadGood("animations.gltf", at(1.5));
  expectNear(placed(earlier, 1, {1.0F, 0.0F, 0.0F}), {std::cos(angle), std::sin(angle), 7.0F}, 1e-4F);
}

TEST(GltfAnimation, AMatrixIsTakenApartAndKeepsWhatIsNotAnimated) {
  const Scene scene = loadGood("animations.gltf", at(2.0));
  // Its scale is 0.5 now, its quarter turn and its translation are as before.
  expectNear(placed(scene, 2, {1.0F, 0.0F, 0.0F}), {5.0F, 6.5F, 7.0F});
  expectNear(placed(scene, 2, {0.0F, 1.0F, 0.0F}), {4.5F, 6.0F, 7.0F});
  const Scene nothing = loadGood("animations.gltf", at(3.0));
  expectNear(placed(nothing, 2, {1.0F, 1.0F, 1.0F}), {5.0F, 6.0F, 7.0F});
}

TEST(GltfAnimation, StepsHoldUntilTheNextKey) {
  expectNear(originOf(loadGood("animations.gltf", at(2.999)), 3), {1.0F, 0.0F, 0.0F});
  expectNear(originOf(loadGood("animations.gltf", at(3.0)), 3), {2.0F, 0.0F, 0.0F});
}

TEST(GltfAnimation, CubicSplinesFollowTheirTangents) {
  // In the middle: 4 / 2 of the second value, and 1/8 of 2 seconds times the first tangent of 2.
  expectNear(originOf(loadGood("animations.gltf", at(2.0)), 4), {2.5F, 0.0F, 0.0F});
  expectNear(originOf(loadGood("animations.gltf", at(3.0)), 4), {4.0F, 0.0F, 0.0F});
}

TEST(GltfAnimation, TimesOutsideAreThoseOfTheEnds) {
  expectNear(originOf(loadGood("animations.gltf", at(-5.0)), 0), {0.0F, 0.0F, 0.0F});
  const Scene scene = loadGood("animations.gltf", at(99.0));
  expectNear(originOf(scene, 0), {4.0F, 0.0F, 0.0F});
  expectNear(placed(scene, 1, {1.0F, 0.0F, 0.0F}), {0.0F, 1.0F, 7.0F}, 1e-4F);
  expectNear(originOf(scene, 4), {4.0F, 0.0F, 0.0F});
}

TEST(GltfAnimation, WhatOtherThingsItMovesIsSaid) {
  const Scene scene = loadGood("animations.gltf", at(2.0));
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_NE(scene.warnings[0].find("KHR_animation_pointer"), std::string::npos) << scene.warnings[0];
}

TEST(GltfAnimation, IsChosenByNameOrNumber) {
  for (const char* choice : {"rise", "1"}) {
    LoadOptions options = animation(choice);
    options.time = 5.5;
    // Halfway between 0.5, at 1, and 10.5, at 2.
    expectNear(originOf(loadGood("animations.gltf", options), 0), {0.0F, 1.5F, 0.0F});
    // The other one does not move anything.
    expectNear(originOf(loadGood("animations.gltf", options), 3), {0.0F, 0.0F, 0.0F});
  }
  expectNear(originOf(loadGood("animations.gltf", animation("walk")), 3), {1.0F, 0.0F, 0.0F});
}

TEST(GltfAnimation, WhatTheFileDoesNotHaveIsRefused) {
  EXPECT_EQ(refusalOf("animations.gltf", animation("fly")),
            "has no animation \"fly\"; it has numbers 0 \"walk\", 1 \"rise\"");
  EXPECT_EQ(refusalOf("animations.gltf", animation("2")),
            "has no animation \"2\"; it has numbers 0 \"walk\", 1 \"rise\"");
  EXPECT_EQ(refusalOf("triangle.gltf", at(1.0)), "holds no animations");
  EXPECT_EQ(refusalOf("box.obj", at(1.0)), "holds no animations: files of its format cannot");
}

TEST(GltfAnimation, TheFilesAnimationsAreListedWithTheirLengths) {
  const std::vector<FileFacts::Animation> list = loadGood("animations.gltf").file.animations;
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].name, "walk");
  EXPECT_EQ(list[0].seconds, 3.0);
  EXPECT_EQ(list[1].name, "rise");
  EXPECT_EQ(list[1].seconds, 10.5);
}

TEST(GltfAnimation, SkinsFollowTheirJoints) {
  const Scene scene = loadGood("animated_skin.gltf", at(1.0));
  ASSERT_EQ(scene.draws.size(), 1U);
  // An eighth of a turn about z; the second corner follows the joint that is 1 further along z.
  expectNear(placed(scene, 0, scene.meshes.at(0).positions.at(0)), {0.0F, 0.0F, 0.0F});
  expectNear(placed(scene, 0, scene.meshes[0].positions.at(1)), {halfRoot, halfRoot, 1.0F});
  expectNear(placed(scene, 0, scene.meshes[0].positions.at(2)), {-halfRoot, halfRoot, 0.0F});
}

TEST(GltfAnimation, MorphTargetsFollowTheirWeights) {
  expectNear(loadGood("animated_morph.gltf").meshes.at(0).positions.at(0), {1.0F, 0.0F, 1.0F});
  // Halfway from none of both to all of the first and a fifth of the second.
  expectNear(loadGood("animated_morph.gltf", at(0.5)).meshes.at(0).positions.at(0), {0.1F, 0.0F, 0.5F});
  expectNear(loadGood("animated_morph.gltf", animation("0")).meshes.at(0).positions.at(0), {0.0F, 0.0F, 0.0F});
}

} // namespace
} // namespace vitrail::tool
