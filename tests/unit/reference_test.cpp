// The double-precision reference against values computed by hand.
#include "../reference/reference.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "../reference/compare.h"
#include "../reference/rays.h"
#include "../reference/shading.h"
#include "../reference/surfaces.h"
#include "../reference/test_scenes.h"

namespace vitrail::tool::reference {
namespace {

void expectNear(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance) {
  EXPECT_NEAR(actual.r, expected.r, tolerance);
  EXPECT_NEAR(actual.g, expected.g, tolerance);
  EXPECT_NEAR(actual.b, expected.b, tolerance);
}

void expectPixel(const ReferencePicture& picture, std::size_t index, const std::array<int, 4>& expected) {
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_EQ(int{picture.picture.rgba[index * 4 + c]}, expected[c]) << "pixel " << index << ", channel " << c;
  }
}

ReferenceOptions straightOptions(std::uint32_t width, std::uint32_t height) {
  ReferenceOptions options;
  options.width = width;
  options.height = height;
  options.view = straightView();
  return options;
}

// |x| + |y| + |z| = 1: every point of it is known in closed form.
Scene octahedron(const glm::mat4& transform) {
  Scene scene;
  Mesh mesh;
  for (const glm::vec3 corner : {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, -1, 0),
                                 glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)}) {
    Vertex vertex;
    vertex.position = corner;
    vertex.normal = corner;
    mesh.add(vertex);
  }
  mesh.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  scene.meshes.push_back(mesh);
  scene.materials.push_back(unlitMaterial(glm::vec4(1.0F, 1.0F, 1.0F, 0.5F)));
  Draw draw;
  draw.transform = transform;
  scene.draws.push_back(draw);
  return scene;
}

TEST(ReferenceShading, SrgbCurve) {
  EXPECT_NEAR(decodeSrgb(0.5), 0.214041140, 1e-9);
  EXPECT_NEAR(encodeSrgb(0.5), 0.735356983, 1e-9);
  EXPECT_NEAR(decodeSrgb(0.02), 0.02 / 12.92, 1e-15);
  EXPECT_DOUBLE_EQ(encodeSrgb(1.0), 1.0);
  for (int i = 0; i < 256; ++i) EXPECT_EQ(int{quantize8(encodeSrgb(decodeSrgb(i / 255.0)))}, i);
  EXPECT_EQ(int{quantize8(2.0)}, 255);
  EXPECT_EQ(int{quantize8(-1.0)}, 0);
  EXPECT_EQ(int{quantize8(std::numeric_limits<double>::quiet_NaN())}, 0);
}

TEST(ReferenceShading, Sky) {
  expectNear(skyColor({1, 0, 0}), {0.70, 0.78, 0.88}, 1e-12);
  expectNear(skyColor({0, 1, 0}), {0.18, 0.36, 0.70}, 1e-12);
  expectNear(skyColor({0, -1, 0}), {0.30, 0.28, 0.26}, 1e-12);
  expectNear(skyColor({std::sqrt(1.0 - 0.0625), 0.25, 0}), {0.44, 0.57, 0.79}, 1e-12); // half way: sqrt(0.25)
}

// N = V = L: F = F0, D = 1 / pi and Vis = 1/4, so direct is 2 (0.96 + 0.01) / pi; the hemisphere is at its middle.
TEST(ReferenceShading, RoughDielectricAtNormalIncidence) {
  Surface surface;
  surface.metallic = 0.0;
  expectNear(shade(surface), {0.6175212 + 0.2808, 0.6175212 + 0.286, 0.6175212 + 0.3016}, 1e-7);
}

// Roughness 1/2 makes a = 1/4 and D = 16 / pi at the peak: direct is 8 / pi times the base colour.
TEST(ReferenceShading, MetalAtNormalIncidence) {
  Surface surface;
  surface.base = {0.5, 0.25, 1.0};
  surface.roughness = 0.5;
  surface.emissive = {0.0, 0.0, 0.125};
  expectNear(shade(surface), {1.4082395, 0.7053697, 2.9614791}, 1e-7);
}

// Light 60 degrees off on black: F = 0.04 + 0.96 (1 - cos 30)^5, Vis = 1/3, NL = 1/2, so direct is F / (3 pi).
TEST(ReferenceShading, ObliqueLight) {
  Surface surface;
  surface.base = glm::dvec3(0.0);
  surface.metallic = 0.0;
  surface.toLight = {std::sqrt(0.75), 0.0, 0.5};
  const double direct = 0.0400414365 / (3.0 * std::numbers::pi);
  expectNear(shade(surface), {direct + 0.0108, direct + 0.011, direct + 0.0116}, 1e-9);
}

// From below, lit from above: no direct light, and both hemispheres show their ground.
TEST(ReferenceShading, LightBehind) {
  Surface surface;
  surface.normal = {0, -1, 0};
  surface.toEye = {0, -1, 0};
  surface.toLight = glm::normalize(glm::dvec3(0.1, 1.0, 0.0));
  surface.metallic = 0.0;
  expectNear(shade(surface), {1.04 * 0.18, 1.04 * 0.17, 1.04 * 0.16}, 1e-12);
}

// All below look from where the light is, straight on: the hemisphere's middle is on both sides.
constexpr glm::dvec3 kMiddle(0.27, 0.275, 0.29);
constexpr double kPi = std::numbers::pi;

Surface straightOn() {
  Surface surface;
  surface.metallic = 0.0;
  surface.base = {0.5, 0.25, 1.0};
  return surface;
}

TEST(ReferenceShading, WithoutSpecularOnlyTheDiffuseIsLeft) {
  Surface surface = straightOn();
  surface.specular = 0.0;
  expectNear(shade(surface), surface.base * (2.0 / kPi + kMiddle), 1e-12);
}

// An index of 0 stands for infinity; at roughness 1 D is 1 / pi and Vis 1/4.
TEST(ReferenceShading, AnInfiniteIndexReflectsAll) {
  Surface surface = straightOn();
  surface.ior = 0.0;
  expectNear(shade(surface), 0.5 / kPi + kMiddle, 1e-12);
}

TEST(ReferenceShading, SpecularGlossiness) {
  Surface surface = straightOn();
  surface.specularGlossiness = true;
  surface.specularColor = {0.5, 0.25, 0.0};
  const glm::dvec3 f = surface.specularColor;
  const glm::dvec3 diffuse = 0.5 * surface.base;
  expectNear(shade(surface), 2.0 * ((1.0 - f) * diffuse / kPi + f / (4.0 * kPi)) + kMiddle * (diffuse + f), 1e-12);
}

TEST(ReferenceShading, AClearcoatReflectsAtwentyfifth) {
  Surface surface = straightOn();
  const glm::dvec3 bare = shade(surface);
  surface.clearcoat = 0.5;
  surface.clearcoatRoughness = 1.0;
  expectNear(shade(surface), 0.98 * bare + 0.02 * (0.5 / kPi + kMiddle), 1e-12);
}

// Fibres do not shine back at the light, and take from what is below what the table says: 0.141.
TEST(ReferenceShading, SheenStraightOn) {
  Surface surface = straightOn();
  const glm::dvec3 bare = shade(surface);
  surface.sheenColor = {0.5, 0.2, 0.0};
  surface.sheenRoughness = 1.0;
  expectNear(shade(surface), bare * (1.0 - 0.5 * 0.141) + kMiddle * surface.sheenColor * 0.141, 1e-12);
}

// Roughness 1/2 along one axis and 1 along the other: D = 1 / (pi * 1/4 * 1).
TEST(ReferenceShading, GroovesStraightOn) {
  Surface surface = straightOn();
  surface.metallic = 1.0;
  surface.roughness = 0.5;
  surface.anisotropy = 1.0;
  expectNear(shade(surface), surface.base * (2.0 / kPi + kMiddle), 1e-12);
}

TEST(ReferenceShading, NoFilmIsNearlyNone) {
  Surface surface = straightOn();
  const glm::dvec3 bare = shade(surface);
  surface.iridescence = 1.0;
  surface.filmThickness = 0.0;
  expectNear(shade(surface), bare, 0.01);
  surface.filmThickness = 300.0;
  EXPECT_GT(glm::length(shade(surface) - bare), 0.01);
}

TEST(ReferenceShading, LightFromTheOtherSideComesThrough) {
  Surface surface = straightOn();
  surface.toLight = {0.0, 0.0, -1.0};
  surface.diffuseTransmission = 1.0;
  surface.diffuseTransmissionColor = {0.1, 0.8, 0.3};
  const glm::dvec3 through = surface.diffuseTransmissionColor;
  expectNear(shade(surface), through * (2.0 * 0.96 / kPi + kMiddle) + 0.04 * kMiddle, 1e-12);
}

TEST(ReferenceShading, LightsOfTheScene) {
  Light light;
  light.position = {0.0F, 0.0F, 3.0F};
  light.intensity = {8.0F, 4.0F, 2.0F};
  const glm::dvec3 point(0.0, 0.0, 1.0);
  expectNear(shineOf(light, 0.5, point).strength, {1.0, 0.5, 0.25}, 1e-12);
  expectNear(shineOf(light, 0.5, point).toLight, {0.0, 0.0, 1.0}, 1e-12);
  light.range = 4.0F;
  expectNear(shineOf(light, 0.5, point).strength, 0.9375 * glm::dvec3(1.0, 0.5, 0.25), 1e-12);
  light.kind = Light::Kind::Spot; // 60 degrees off between 45 and 90
  light.direction = {std::sqrt(0.75F), 0.0F, -0.5F};
  light.innerConeAngle = 0.25F * std::numbers::pi_v<float>;
  light.outerConeAngle = 0.5F * std::numbers::pi_v<float>;
  expectNear(shineOf(light, 0.5, point).strength, 0.5 * 0.9375 * glm::dvec3(1.0, 0.5, 0.25), 1e-6);
}

// What passes through a dielectric is not scattered back: at t = 1 only what black would reflect is left.
TEST(ReferenceShading, TransmittedLightIsNotScattered) {
  Surface glass;
  glass.metallic = 0.0;
  glass.base = {0.2, 0.5, 0.8};
  glass.transmission = 1.0;
  Surface black = glass;
  black.base = glm::dvec3(0.0);
  black.transmission = 0.0;
  expectNear(shade(glass), shade(black), 1e-12);
  glass.transmission = 0.25;
  Surface dull = black;
  dull.base = 0.75 * glass.base;
  expectNear(shade(glass), shade(dull), 1e-12);
}

TEST(ReferenceShading, TextureFilterAndWrap) {
  Image image;
  image.width = 2;
  image.height = 1;
  image.rgba = {0, 0, 0, 0, 255, 255, 255, 255};
  TextureSlot slot;
  slot.image = 0;
  const auto red = [&](double u) { return sampleColorTexture(image, slot, {u, 0.5}).r; };
  EXPECT_NEAR(red(0.25), 0.0, 1e-12);
  EXPECT_NEAR(red(0.5), 0.5, 1e-12);
  EXPECT_NEAR(red(0.625), 0.75, 1e-12);
  EXPECT_NEAR(red(0.0), 0.5, 1e-12);
  EXPECT_NEAR(red(-1.25), 1.0, 1e-12);
  slot.sampler.wrapU = Wrap::ClampToEdge;
  EXPECT_NEAR(red(0.0), 0.0, 1e-12);
  EXPECT_NEAR(red(7.0), 1.0, 1e-12);
  slot.sampler.wrapU = Wrap::MirroredRepeat;
  EXPECT_NEAR(red(-0.25), 0.0, 1e-12);
  EXPECT_NEAR(red(1.25), 1.0, 1e-12);
  EXPECT_NEAR(red(1.75), 0.0, 1e-12);
  slot.transform[2] = glm::vec3(0.25F, 0.0F, 1.0F);
  EXPECT_NEAR(red(0.25), 0.5, 1e-12);
}

// Rays go exactly through corners and along edges here: still each pierces the surface once on either side.
TEST(ReferenceRays, ClosedSurfaceIsHitTwice) {
  for (const float mirror : {1.0F, -1.0F}) {
    const Scene scene = octahedron(glm::scale(glm::mat4(1.0F), glm::vec3(mirror, 1.0F, 1.0F)));
    const RayScene rays(scene, straightView());
    std::vector<RayHit> hits;
    for (int y = -20; y <= 20; ++y) {
      for (int x = -20; x <= 20; ++x) {
        const glm::dvec2 at(x / 16.0, y / 16.0);
        PictureRay ray;
        ray.origin = at;
        rays.allHits(ray, hits);
        const double height = 1.0 - std::abs(at.x) - std::abs(at.y);
        if (height == 0.0) continue; // the outline: either answer is right
        ASSERT_EQ(hits.size(), height > 0.0 ? 2U : 0U) << at.x << ", " << at.y;
        for (const RayHit& hit : hits) EXPECT_NEAR(hit.depth, hit.front ? 10.0 - height : 10.0 + height, 1e-12);
      }
    }
  }
}

// The picture's rays through a perspective view: a square at distance 2 with a half side of 1 covers the middle
// quarter.
TEST(ReferenceRays, PerspectiveCoverage) {
  Scene scene;
  addRectangle(scene, {glm::vec2(-1.0F), glm::vec2(1.0F), -2.0F}, unlitMaterial(glm::vec4(1.0F)));
  const RayScene rays(scene, wideView());
  std::vector<RayHit> hits;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      rays.allHits(pictureRay(wideView(), {x + 0.5, y + 0.5}, {64, 32}), hits);
      const bool inside = x >= 24 && x < 40 && y >= 8 && y < 24;
      ASSERT_EQ(hits.size(), inside ? 1U : 0U) << x << ", " << y;
      for (const RayHit& hit : hits) EXPECT_NEAR(hit.depth, 2.0, 1e-12);
    }
  }
}

// Red over green over blue, all half: (1/2, 1/4, 1/4). 8-bit alphas are 128/255.
TEST(ReferencePictureTest, TwoLayersOverAColor) {
  Scene scene;
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -1.0F}, unlitMaterial({0.0F, 1.0F, 0.0F, 0.5F}));
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 1.0F}, unlitMaterial({1.0F, 0.0F, 0.0F, 0.5F}));
  ReferenceOptions options = straightOptions(4, 3);
  options.background.srgb = {0.0F, 0.0F, 1.0F};
  const Reference reference = renderReference(scene, options);
  for (std::size_t i = 0; i < 12; ++i) {
    expectNear(reference.exact.linear[i], {0.5, 0.25, 0.25}, 1e-7);
    expectNear(reference.rounded.linear[i], {128.0 / 255, 127.0 * 128 / 65025, 127.0 * 127 / 65025}, 1e-12);
    expectPixel(reference.exact, i, {188, 137, 137, 255});
    EXPECT_EQ(reference.layers[i], 2U);
    EXPECT_EQ(int{reference.edge[i]}, 0);
  }
}

TEST(ReferencePictureTest, TransparentBackgroundIsStraightAlpha) {
  Scene scene;
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -1.0F}, unlitMaterial({0.0F, 1.0F, 0.0F, 0.5F}));
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 1.0F}, unlitMaterial({1.0F, 0.0F, 0.0F, 0.5F}));
  ReferenceOptions options = straightOptions(2, 2);
  options.background.kind = Background::Kind::Transparent;
  const Reference reference = renderReference(scene, options);
  EXPECT_TRUE(reference.exact.picture.hasAlpha);
  expectPixel(reference.exact, 3, {213, 156, 0, 191}); // (2/3, 1/3, 0) on the sRGB curve, 3/4
}

TEST(ReferencePictureTest, OpaqueSurfacesHideWhatIsBehindThem) {
  Scene scene;
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -1.0F}, unlitMaterial({0.0F, 1.0F, 0.0F, 0.5F}));
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(0.0F, 9.0F), 0.0F},
               unlitMaterial(glm::vec4(1.0F), AlphaMode::Opaque));
  const std::uint32_t back = addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 1.0F},
                                          unlitMaterial({1.0F, 0.0F, 0.0F, 1.0F}, AlphaMode::Opaque));
  scene.draws[back].transform = glm::rotate(glm::mat4(1.0F), std::numbers::pi_v<float>, glm::vec3(0, 1, 0));
  scene.draws[back].transform[3].z = 3.0F; // turned round at z = 2: single-sided, so it is not seen
  ReferenceOptions options = straightOptions(2, 1);
  options.background.srgb = {0.0F, 0.0F, 0.0F};
  Reference reference = renderReference(scene, options);
  expectPixel(reference.exact, 0, {255, 255, 255, 255});
  expectPixel(reference.exact, 1, {0, 188, 0, 255});
  EXPECT_EQ(reference.layers[0], 0U);
  EXPECT_EQ(reference.layers[1], 1U);

  options.opacity = 0.5F; // everything is glass, from both sides
  reference = renderReference(scene, options);
  EXPECT_EQ(reference.layers[0], 3U);
  expectNear(reference.exact.linear[0], {0.5 + 0.25, 0.25 + 0.25 * 0.25, 0.25}, 1e-7);
}

TEST(ReferencePictureTest, MaskedAndClippedSurfacesAreNotThere) {
  Scene scene;
  Material cut = unlitMaterial({1.0F, 0.0F, 0.0F, 0.25F}, AlphaMode::Mask);
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 2.0F}, cut);
  cut.alphaCutoff = 0.25F; // not below the cutoff: there, and opaque
  cut.baseColor = {0.0F, 1.0F, 0.0F, 0.25F};
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 1.0F}, cut);
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 9.5F}, unlitMaterial({1.0F, 1.0F, 1.0F, 0.5F})); // too near
  const Reference reference = renderReference(scene, straightOptions(1, 1));
  expectPixel(reference.exact, 0, {0, 255, 0, 255});
  EXPECT_EQ(reference.layers[0], 0U);
}

// Alpha below half a step is not stored; the exact picture still has it.
TEST(ReferencePictureTest, FaintFragmentsAreNotStored) {
  Scene scene;
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 0.0F}, unlitMaterial({1.0F, 1.0F, 1.0F, 0.0019F}));
  ReferenceOptions options = straightOptions(1, 1);
  options.background.srgb = glm::vec3(0.0F);
  const Reference reference = renderReference(scene, options);
  EXPECT_EQ(reference.layers[0], 0U);
  EXPECT_EQ(reference.rounded.linear[0].r, 0.0);
  EXPECT_NEAR(reference.exact.linear[0].r, 0.0019, 1e-9);
}

// A side of a rectangle goes through the centres of pixel column 4; another lies between columns. Its diagonal is
// inside the surface and marks nothing.
TEST(ReferencePictureTest, OnlySilhouettesNearAPixelCentreAreEdges) {
  Scene scene;
  const float left = 2.0F * 4.5F / 16.0F - 1.0F;
  addRectangle(scene, {glm::vec2(left, -9.0F), glm::vec2(0.5F, 9.0F), 0.0F}, unlitMaterial({1.0F, 0.0F, 0.0F, 0.5F}));
  const Reference reference = renderReference(scene, straightOptions(16, 16));
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_EQ(int{reference.edge[i]}, i % 16 == 4 ? 1 : 0) << i;
    EXPECT_EQ(reference.layerRanges[i].most, i % 16 >= 4 && i % 16 < 12 ? 1U : 0U) << i;
    EXPECT_EQ(reference.layerRanges[i].least, i % 16 > 4 && i % 16 < 12 ? 1U : 0U) << i;
  }
}

TEST(ReferencePictureTest, EqualDepthsOfDifferentColorsAreEdges) {
  Scene scene;
  const Rectangle all{glm::vec2(-9.0F), glm::vec2(9.0F), 0.0F};
  addRectangle(scene, all, unlitMaterial({1.0F, 0.0F, 0.0F, 0.5F}));
  addRectangle(scene, all, unlitMaterial({1.0F, 0.0F, 0.0F, 0.5F}));
  EXPECT_EQ(int{renderReference(scene, straightOptions(1, 1)).edge[0]}, 0);
  scene.materials[1].baseColor = {0.0F, 0.0F, 1.0F, 0.5F};
  EXPECT_EQ(int{renderReference(scene, straightOptions(1, 1)).edge[0]}, 1);
  scene.materials[1].alphaMode = AlphaMode::Opaque; // drawn over it or hidden by it
  EXPECT_EQ(int{renderReference(scene, straightOptions(1, 1)).edge[0]}, 1);
}

// A plane that faces the camera through a whole scene: the light is fixed to the camera, so any straight view of a
// plane shades alike up to the hemisphere. Here N = V = +Z, L = (-0.4, 0.7, 0.6) / sqrt(1.01).
TEST(ReferencePictureTest, LitPlane) {
  Scene scene;
  Material white;
  white.metallic = 0.0F;
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 0.0F}, white);
  const Reference reference = renderReference(scene, straightOptions(1, 1));
  // NL = 0.5970223, H = (L + V) normalised, VH = NH = sqrt((1 + NL) / 2) = 0.8935945; F = 0.0400131;
  // D = 1 / pi, Vis = 0.5 / (NL + 1) = 0.3130827.
  const double direct = 2.0 * 0.5970223 * (0.9599869 + 0.0400131 * 0.3130827) / std::numbers::pi;
  expectNear(reference.exact.linear[0], {direct + 0.2808, direct + 0.286, direct + 0.3016}, 1e-6);
}

// The camera looks along -X, so its right is -Z and its backward +X: L = (0.6, 0.7, 0.4) / sqrt(1.01) in the world.
TEST(ReferencePictureTest, LightTurnsWithTheCamera) {
  Scene scene;
  Material white;
  white.metallic = 0.0F;
  white.roughness = 0.5F;
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 0.0F}, white);
  scene.draws[0].transform = glm::rotate(glm::mat4(1.0F), glm::radians(60.0F), glm::vec3(0, 1, 0));
  ReferenceOptions options = straightOptions(1, 1);
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0F), glm::radians(90.0F), glm::vec3(0, 1, 0));
  options.view.cameraToWorld = turn * options.view.cameraToWorld;
  Surface surface;
  surface.normal = {std::sqrt(0.75), 0.0, 0.5};
  surface.toEye = {1.0, 0.0, 0.0};
  surface.toLight = glm::normalize(glm::dvec3(0.6, 0.7, 0.4));
  surface.metallic = 0.0;
  surface.roughness = 0.5;
  expectNear(renderReference(scene, options).exact.linear[0], shade(surface), 1e-6);
}

// The four pixels' centres meet a plane at distance 2 in (-1 or 1, -1 or 1, -2): each has its own V.
TEST(ReferencePictureTest, PerspectiveViewDirection) {
  Scene scene;
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -2.0F}, Material{});
  ReferenceOptions options = straightOptions(2, 2);
  options.view = wideView();
  const Reference reference = renderReference(scene, options);
  Surface surface;
  surface.toLight = glm::normalize(glm::dvec3(-0.4, 0.7, 0.6));
  surface.toEye = glm::normalize(glm::dvec3(1, -1, 2)); // from the top left pixel
  expectNear(reference.exact.linear[0], shade(surface), 1e-6);
  surface.toEye = glm::normalize(glm::dvec3(-1, 1, 2)); // from the bottom right one
  expectNear(reference.exact.linear[3], shade(surface), 1e-6);
}

TEST(ReferencePictureTest, PerspectiveClipsByViewDepth) {
  Scene scene;
  for (const float z : {-0.49F, -0.51F, -2.99F, -3.01F}) {
    addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), z}, unlitMaterial(glm::vec4(0.5F)));
  }
  ReferenceOptions options = straightOptions(2, 2);
  options.view = wideView();
  EXPECT_EQ(renderReference(scene, options).layers[0], 3U);
  options.view.farPlane = 3.0F;
  EXPECT_EQ(renderReference(scene, options).layers[0], 2U);
}

const Rectangle kAll{glm::vec2(-9.0F), glm::vec2(9.0F), 0.0F};

// Red of alpha 1/2 adds half of red; the picture's alpha stays.
TEST(ReferenceBlendModes, AdditiveSurfacesAddTheirLight) {
  Scene scene;
  Material flame = unlitMaterial({1.0F, 0.0F, 0.0F, 0.5F});
  flame.blend = BlendMode::Additive;
  addRectangle(scene, kAll, flame);
  ReferenceOptions options = straightOptions(1, 1);
  options.background.srgb = {0.0F, 0.0F, 1.0F};
  expectNear(renderReference(scene, options).exact.linear[0], {0.5, 0.0, 1.0}, 1e-7);
  options.background.kind = Background::Kind::Transparent;
  const Reference reference = renderReference(scene, options);
  expectNear(reference.exact.linear[0], {0.5, 0.0, 0.0}, 1e-7);
  EXPECT_EQ(reference.exact.linear[0].a, 0.0);
  expectNear(reference.rounded.linear[0], {128.0 / 255, 0.0, 0.0}, 1e-12);
  scene.materials[0].alphaMode = AlphaMode::Opaque; // only blended surfaces add
  expectNear(renderReference(scene, options).exact.linear[0], {1.0, 0.0, 0.0}, 1e-7);
}

Material glass() {
  Material material;
  material.transmission = 0.75F;
  material.metallic = 0.25F;
  material.roughness = 0.5F;
  material.baseColor = {0.25F, 0.5F, 0.75F, 1.0F};
  return material;
}

// C + q * base * d, and with an X-ray factor k: k * C + mix(1, q * base, k) * d.
TEST(ReferenceBlendModes, TransmissionTintsWhatIsBehind) {
  Scene scene;
  addRectangle(scene, kAll, glass());
  Surface surface;
  surface.toLight = glm::normalize(glm::dvec3(-0.4, 0.7, 0.6));
  surface.base = {0.25, 0.5, 0.75};
  surface.metallic = 0.25;
  surface.roughness = 0.5;
  surface.transmission = 0.75;
  const glm::dvec3 c = shade(surface);
  const double q = 0.75 * 0.75;
  ReferenceOptions options = straightOptions(1, 1);
  options.background.srgb = {1.0F, 0.0F, 1.0F};
  const glm::dvec3 d(1.0, 0.0, 1.0);
  Reference reference = renderReference(scene, options);
  expectNear(reference.exact.linear[0], c + q * surface.base * d, 1e-7);
  EXPECT_EQ(reference.layers[0], 2U);
  // Stored: alpha 1 - q = 0.4375 is 112/255, and the tint whole.
  EXPECT_NEAR(reference.rounded.linear[0].a, 1.0, 1e-12);
  options.background.kind = Background::Kind::Transparent;
  EXPECT_NEAR(renderReference(scene, options).rounded.linear[0].a, 112.0 / 255, 1e-12);
  options.background.kind = Background::Kind::Color;
  options.opacity = 0.5F;
  reference = renderReference(scene, options);
  expectNear(reference.exact.linear[0], 0.5 * c + (0.5 + 0.5 * q * surface.base) * d, 1e-7);
}

// Two panes at different depths: the tint of the front one applies to the reflection of the one behind it.
TEST(ReferenceBlendModes, PanesKeepTheirFragmentsTogether) {
  Scene scene;
  Material front = glass();
  front.roughness = 1.0F;
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -1.0F}, glass());
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 1.0F}, front);
  const auto colorOf = [&](double roughness) {
    Surface surface;
    surface.toLight = glm::normalize(glm::dvec3(-0.4, 0.7, 0.6));
    surface.base = {0.25, 0.5, 0.75};
    surface.metallic = 0.25;
    surface.roughness = roughness;
    surface.transmission = 0.75;
    return shade(surface);
  };
  const glm::dvec3 tint = 0.75 * 0.75 * glm::dvec3(0.25, 0.5, 0.75);
  const Reference reference = renderReference(scene, straightOptions(1, 1)); // over white
  expectNear(reference.exact.linear[0], colorOf(1.0) + tint * (colorOf(0.5) + tint), 1e-7);
  EXPECT_EQ(reference.layers[0], 4U);
}

TEST(ReferenceBlendModes, UnlitSurfacesDoNotTransmit) {
  Scene scene;
  Material material = unlitMaterial({0.0F, 1.0F, 0.0F, 1.0F}, AlphaMode::Opaque);
  material.transmission = 1.0F;
  addRectangle(scene, kAll, material);
  const Reference reference = renderReference(scene, straightOptions(1, 1));
  expectPixel(reference.exact, 0, {0, 255, 0, 255});
  EXPECT_EQ(reference.layers[0], 0U);
}

TEST(ReferenceNodeFormats, EachRoundsAndClampsInItsOwnWay) {
  Scene scene;
  addRectangle(scene, kAll, unlitMaterial({4.0F, 0.5F, 0.0F, 0.5F}));
  ReferenceOptions options = straightOptions(1, 1);
  options.background.srgb = glm::vec3(0.0F);
  Reference reference = renderReference(scene, options);
  EXPECT_NEAR(reference.exact.linear[0].r, 0.5, 1e-7); // clamped to 1
  options.nodeFormat = layout::VITRAIL_FORMAT_COMPACT;
  reference = renderReference(scene, options);
  EXPECT_NEAR(reference.rounded.linear[0].r, 32.0 / 63, 1e-12);
  EXPECT_NEAR(reference.rounded.linear[0].g, 32.0 / 63 * decodeSrgb(46.0 / 63), 1e-12); // 0.7353570 * 63 = 46.33
  options.nodeFormat = layout::VITRAIL_FORMAT_HDR;
  reference = renderReference(scene, options);
  EXPECT_NEAR(reference.exact.linear[0].r, 2.0, 1e-7);
  EXPECT_NEAR(reference.rounded.linear[0].r, 4.0 * (46340.0 / 65535) * (46340.0 / 65535), 1e-12);
}

TEST(ReferenceSamples, PositionsAreTheStandardOnes) {
  for (const std::uint32_t samples : {1U, 2U, 4U, 8U}) {
    glm::dvec2 sum(0.0);
    for (std::uint32_t s = 0; s < samples; ++s) {
      sum += standardSamplePosition(samples, s);
      for (std::uint32_t other = 0; other < s; ++other) { // no two in one row or column
        EXPECT_NE(standardSamplePosition(samples, s).x, standardSamplePosition(samples, other).x);
        EXPECT_NE(standardSamplePosition(samples, s).y, standardSamplePosition(samples, other).y);
      }
    }
    EXPECT_NEAR(sum.x / samples, 0.5, samples == 8 ? 0.04 : 1e-12);
  }
  EXPECT_EQ(standardSamplePosition(2, 0), glm::dvec2(0.75, 0.75));
  EXPECT_EQ(standardSamplePosition(4, 0), glm::dvec2(0.375, 0.125));
  EXPECT_EQ(standardSamplePosition(4, 1), glm::dvec2(0.875, 0.375));
  EXPECT_EQ(standardSamplePosition(4, 2), glm::dvec2(0.125, 0.625));
  EXPECT_EQ(standardSamplePosition(4, 3), glm::dvec2(0.625, 0.875));
  EXPECT_EQ(standardSamplePosition(8, 0), glm::dvec2(0.5625, 0.3125));
  EXPECT_EQ(standardSamplePosition(8, 3), glm::dvec2(0.3125, 0.1875));
  EXPECT_EQ(standardSamplePosition(8, 7), glm::dvec2(0.9375, 0.0625));
}

// A rectangle over the left part of a pixel, up to `edge`, in pixels of a picture of one.
Rectangle leftOf(float edge, float z) { return {glm::vec2(-9.0F), glm::vec2(2.0F * edge - 1.0F, 9.0F), z}; }

TEST(ReferenceSamples, ASurfaceCoversWhatLiesInside) {
  for (const auto& [samples, edge, share] :
       {std::tuple(1U, 0.6F, 1.0), std::tuple(2U, 0.6F, 0.5), std::tuple(4U, 0.6F, 0.5), std::tuple(4U, 0.2F, 0.25),
        std::tuple(4U, 0.7F, 0.75), std::tuple(8U, 0.1F, 0.125), std::tuple(8U, 0.6F, 0.625)}) {
    Scene scene;
    addRectangle(scene, leftOf(edge, 0.0F), unlitMaterial({1.0F, 1.0F, 1.0F, 0.5F}));
    ReferenceOptions options = straightOptions(1, 1);
    options.background.srgb = glm::vec3(0.0F);
    options.samples = samples;
    const Reference reference = renderReference(scene, options);
    EXPECT_NEAR(reference.exact.linear[0].r, 0.5 * share, 1e-7) << samples << " samples, edge " << edge;
    EXPECT_NEAR(reference.rounded.linear[0].r, 128.0 / 255 * share, 1e-12) << samples << " samples, edge " << edge;
    EXPECT_EQ(reference.layers[0], 1U);
    EXPECT_EQ(int{reference.edge[0]}, 0);
  }
}

// Green glass behind an opaque red rectangle over samples 0 and 2: those stay red, the others are green over blue.
TEST(ReferenceSamples, EachSampleHasItsOwnOpaqueSurface) {
  Scene scene;
  addRectangle(scene, leftOf(0.5F, 1.0F), unlitMaterial({1.0F, 0.0F, 0.0F, 1.0F}, AlphaMode::Opaque));
  addRectangle(scene, kAll, unlitMaterial({0.0F, 1.0F, 0.0F, 0.5F}));
  ReferenceOptions options = straightOptions(1, 1);
  options.background.srgb = {0.0F, 0.0F, 1.0F};
  options.samples = 4;
  expectNear(renderReference(scene, options).exact.linear[0], {0.5, 0.25, 0.25}, 1e-7);
}

// Green glass that falls to the right cuts an opaque red plane in the pixel's middle: it is before it at samples 0
// and 2.
TEST(ReferenceSamples, EverySampleHasItsOwnDepth) {
  Scene scene;
  addRectangle(scene, kAll, unlitMaterial({1.0F, 0.0F, 0.0F, 1.0F}, AlphaMode::Opaque));
  addRectangle(scene, {glm::vec2(-4.0F), glm::vec2(4.0F), 0.0F}, unlitMaterial({0.0F, 1.0F, 0.0F, 0.5F}));
  for (glm::vec3& position : scene.meshes[1].positions) position.z = -position.x;
  ReferenceOptions options = straightOptions(1, 1);
  options.samples = 4;
  expectNear(renderReference(scene, options).exact.linear[0], {0.75, 0.25, 0.0}, 1e-7);
}

// Only the sample at x = 0.875 is covered, and the colour is that of the centre, beyond the surface's edge.
TEST(ReferenceSamples, SurfacesAreShadedAtTheCentre) {
  Scene scene;
  addRectangle(scene, {glm::vec2(0.4F, -9.0F), glm::vec2(2.4F, 9.0F), 0.0F}, unlitMaterial(glm::vec4(1.0F)));
  reference::changeVertices(scene.meshes[0], [](Vertex& vertex) {
    vertex.color = glm::vec4(glm::vec3(0.5F + 0.1F * vertex.position.x), 1.0F); // 0.5 at the centre, x = 0
  });
  ReferenceOptions options = straightOptions(1, 1);
  options.background.srgb = glm::vec3(0.0F);
  options.samples = 4;
  expectNear(renderReference(scene, options).exact.linear[0], glm::dvec3(0.125), 1e-7);
}

TEST(ReferenceCompare, SeparatesEdgesFromTheRest) {
  Reference reference;
  reference.edge = {0, 1, 0};
  reference.layerRanges = {{1, 1}, {2, 5}, {0, 0}};
  reference.exact.picture = {3, 1, false, std::vector<std::uint8_t>(12, 100)};
  Picture rendered = reference.exact.picture;
  rendered.rgba[1] = 102;
  rendered.rgba[6] = 0;
  rendered.rgba[8] = 97;
  const Comparison comparison = compare(rendered, reference.exact, reference, 2);
  EXPECT_EQ(comparison.away, 3);
  EXPECT_EQ(comparison.awayX, 2U);
  EXPECT_EQ(comparison.beyond, 1U);
  EXPECT_NEAR(comparison.edgeShare, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(comparison.edgeOver, 1.0 / 3.0, 1e-12);
  EXPECT_EQ(layerBounds(reference).fragmentsLeast, 3U);
  EXPECT_EQ(layerBounds(reference).fragmentsMost, 6U);
  EXPECT_EQ(layerBounds(reference).deepestMost, 5U);
  rendered.hasAlpha = true;
  EXPECT_THROW(compare(rendered, reference.exact, reference, 2), std::invalid_argument);
}

TEST(ReferencePictureTest, TexturesBeyondItAreRefused) {
  Scene scene;
  addRectangle(scene, {}, unlitMaterial(glm::vec4(1.0F)));
  scene.materials[0].normalTexture.image = 0;
  EXPECT_THROW(renderReference(scene, straightOptions(1, 1)), std::invalid_argument);
  scene.materials[0].normalTexture.image = -1;
  scene.materials[0].transmissionTexture.image = 0;
  EXPECT_THROW(renderReference(scene, straightOptions(1, 1)), std::invalid_argument);
}

} // namespace
} // namespace vitrail::tool::reference
