// Which meshes enclose a volume, and how strongly that absorbs.
#include "../../tool/scene/volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "../../tool/scene/builtin/builtin.h"
#include "../../tool/scene/builtin/shapes.h"

namespace vitrail::tool {
namespace {

Mesh turnedRound(Mesh mesh) {
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  return mesh;
}

// A corner of its own for each triangle.
Mesh unshared(const Mesh& mesh) {
  Mesh result;
  for (const std::uint32_t index : mesh.indices) {
    result.indices.push_back(static_cast<std::uint32_t>(result.positions.size()));
    result.positions.push_back(mesh.positions[index]);
  }
  return result;
}

TEST(Volume, ClosedBodiesFaceOutwardsOrInwards) {
  const std::array<glm::vec3, 3> curve{glm::vec3(0.0F), glm::vec3(1.0F, 0.2F, 0.0F), glm::vec3(2.0F, 0.0F, 0.5F)};
  const std::array<float, 3> radii{0.1F, 0.2F, 0.1F};
  const std::array bodies{uvSphere(16, 8), capsule(0.3F, 0.2F, 1.0F, 12, 4), disc(1.0F, 0.5F, 0.1F, 16),
                          torus(1.0F, 0.25F, 16, 8), tube(curve, radii, 6)};
  for (const Mesh& body : bodies) {
    EXPECT_EQ(facingOf(body), Facing::Outward);
    EXPECT_EQ(facingOf(unshared(body)), Facing::Outward);
    EXPECT_EQ(facingOf(turnedRound(body)), Facing::Inward);
  }
  Mesh two = uvSphere(8, 4); // bodies may touch: an edge may have more than two triangles
  append(two, uvSphere(8, 4));
  EXPECT_EQ(facingOf(two), Facing::Outward);
}

TEST(Volume, WhatLacksATriangleIsOpen) {
  EXPECT_EQ(facingOf(quad(1.0F, 1.0F)), Facing::Open);
  EXPECT_EQ(facingOf(Mesh{}), Facing::Open);
  const Mesh whole = uvSphere(12, 6);
  for (std::size_t gone = 0; gone < whole.indices.size(); gone += 3) {
    Mesh mesh = whole;
    mesh.indices.erase(mesh.indices.begin() + static_cast<std::ptrdiff_t>(gone),
                       mesh.indices.begin() + static_cast<std::ptrdiff_t>(gone + 3));
    ASSERT_EQ(facingOf(mesh), Facing::Open) << "without triangle " << gone / 3;
    mesh = whole;
    std::swap(mesh.indices[gone], mesh.indices[gone + 1]);
    ASSERT_EQ(facingOf(mesh), Facing::Open) << "with triangle " << gone / 3 << " turned round";
  }
  Mesh sheet = quad(1.0F, 1.0F); // with its own back: nothing is inside
  append(sheet, turnedRound(quad(1.0F, 1.0F)));
  EXPECT_EQ(facingOf(sheet), Facing::Open);
  Mesh lines = whole;
  lines.primitive = Primitive::Lines;
  EXPECT_EQ(facingOf(lines), Facing::Open);
}

TEST(Volume, AbsorptionIsFinite) {
  Material material;
  material.transmission = 1.0F;
  material.thickness = 1.0F;
  material.attenuationDistance = 0.5F;
  material.attenuationColor = {0.0F, 1.0F, 0.25F};
  const glm::vec3 perLength = absorption(material);
  EXPECT_FLOAT_EQ(perLength.r, 2.0F * std::log(0x1p24F)); // a colour of 0 is 2^-24
  EXPECT_EQ(perLength.g, 0.0F);
  EXPECT_FLOAT_EQ(perLength.b, 2.0F * std::log(4.0F));
  material.attenuationDistance = 1e-38F;
  EXPECT_TRUE(std::isfinite(absorption(material).r));
  material.unlit = true;
  EXPECT_EQ(absorption(material), glm::vec3(0.0F));
}

// What is solid is a matter of mesh and material.
TEST(Volume, SolidsAbsorbAndAreClosed) {
  Scene scene;
  scene.meshes = {uvSphere(8, 4), quad(1.0F, 1.0F)};
  scene.materials.resize(3);
  Material& glass = scene.materials[1];
  glass.transmission = glass.thickness = glass.attenuationDistance = 1.0F;
  glass.attenuationColor = glm::vec3(0.5F);
  scene.materials[2] = glass;
  scene.materials[2].alphaMode = AlphaMode::Mask; // may have holes
  scene.draws = {{0, 0, glm::mat4(1.0F)}, {1, 1, glm::mat4(1.0F)}, {0, 2, glm::mat4(1.0F)}};
  EXPECT_FALSE(Solids(scene).any());
  scene.draws.push_back({0, 1, glm::mat4(1.0F)});
  const Solids solids(scene);
  EXPECT_TRUE(solids.any());
  EXPECT_EQ(solids.of(0, 0), Facing::Open);
  EXPECT_EQ(solids.of(0, 1), Facing::Outward);
  EXPECT_EQ(solids.of(0, 2), Facing::Open);
  EXPECT_EQ(solids.of(1, 1), Facing::Open);
}

} // namespace
} // namespace vitrail::tool
