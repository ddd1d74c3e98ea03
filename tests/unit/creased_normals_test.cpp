// Normals that are smooth but for edges, and the table that finds equal places for them.
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "load_good.h"
#include "scene/mesh_build.h"
#include "scene/weld.h"

namespace vitrail::tool {
namespace {

constexpr float crease = 0.7853982F;

TEST(Welder, PlacesAreNumberedAsTheyComeAndTheZerosAreOne) {
  Welder welder;
  EXPECT_EQ(welder.add({1.0F, 2.0F, 3.0F}), 0U);
  EXPECT_EQ(welder.add({0.0F, 0.0F, 0.0F}), 1U);
  EXPECT_EQ(welder.add({1.0F, 2.0F, 3.0F}), 0U);
  EXPECT_EQ(welder.add({-0.0F, 0.0F, -0.0F}), 1U);
  EXPECT_EQ(welder.add({1.0F, 2.0F, 3.0F}, 7), 2U) << "another tag";
  EXPECT_EQ(welder.add({3.0F, 2.0F, 1.0F}), 3U);
  EXPECT_EQ(welder.take().size(), 4U);
  EXPECT_EQ(welder.add({3.0F, 2.0F, 1.0F}), 0U);
}

TEST(Welder, ManyPlacesAreFoundAgainWhenTheTableHasGrown) {
  Welder welder;
  for (int pass = 0; pass < 2; ++pass)
    for (std::uint32_t i = 0; i < 10'000; ++i)
      ASSERT_EQ(welder.add({static_cast<float>(i % 100), static_cast<float>(i / 100), 0.5F}), i);
}

// A strip of squares in the plane z = 0 and one that rises at its end.
Mesh bentStrip(float angle) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0},
                    {0, 1, 0},
                    {1, 0, 0},
                    {1, 1, 0},
                    {1 + std::cos(angle), 0, std::sin(angle)},
                    {1 + std::cos(angle), 1, std::sin(angle)}};
  mesh.indices = {0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5};
  return mesh;
}

TEST(CreasedNormals, VerticesAreSplitAtEdgesOnly) {
  Mesh smooth = bentStrip(0.7F);
  makeCreasedNormals(smooth, crease);
  EXPECT_EQ(smooth.vertexCount(), 6U);
  Mesh edged = bentStrip(0.9F);
  makeCreasedNormals(edged, crease);
  EXPECT_EQ(edged.vertexCount(), 8U);
  for (std::size_t i = 0; i < 6; ++i) expectNear(edged.vertex(edged.indices[i]).normal, {0.0F, 0.0F, 1.0F});
  for (std::size_t i = 6; i < 12; ++i)
    expectNear(edged.vertex(edged.indices[i]).normal, {-std::sin(0.9F), 0.0F, std::cos(0.9F)}, 1e-4F);
}

TEST(CreasedNormals, VerticesOfTheirOwnAtOnePlaceAreSmoothTogetherAndKeepWhatTellsThemApart) {
  Mesh mesh = bentStrip(0.7F);
  separateTriangles(mesh);
  mesh.texCoords0.resize(mesh.vertexCount());
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) mesh.texCoords0[i].x = static_cast<float>(i);
  makeCreasedNormals(mesh, crease);
  ASSERT_EQ(mesh.vertexCount(), 12U);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(mesh.vertex(mesh.indices[i]).texCoord0.x, static_cast<float>(i));
  // Two corners of different triangles at the place (1, 0, 0).
  EXPECT_EQ(mesh.normals[mesh.indices[1]], mesh.normals[mesh.indices[6]]);
}

TEST(CreasedNormals, WhereHundredsMeetEachKeepsItsPlane) {
  constexpr int count = 400;
  Mesh mesh;
  mesh.positions.emplace_back(0.0F, 0.0F, 0.5F);
  for (int i = 0; i < count; ++i) {
    const float angle = 6.2831853F * static_cast<float>(i) / count;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0F);
    mesh.indices.insert(mesh.indices.end(),
                        {0U, 1U + static_cast<std::uint32_t>(i), 1U + static_cast<std::uint32_t>((i + 1) % count)});
  }
  makeCreasedNormals(mesh, crease);
  EXPECT_EQ(mesh.vertexCount(), 2U * count) << "one a triangle at the tip, one a place around it";
  const glm::vec3 first = mesh.vertex(mesh.indices[0]).normal;
  EXPECT_NEAR(first.z, 0.894427F, 1e-3F);
  EXPECT_GT(first.x, 0.4F);
}

} // namespace
} // namespace vitrail::tool
