// The values that STL files load to.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "load_good.h"
#include "plain_checks.h"
#include "scene/load.h"

namespace vitrail::tool::test {
namespace {

using Lines = std::vector<std::string>;

TEST(LoadStl, TextHasNormalsSmoothedOverFlatEdgesOnly) {
  const Scene scene = loadGood("text.stl");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 9U);
  for (std::size_t i = 0; i < 6; ++i) expectNear(cornerAt(mesh, i).normal, {0.0F, 0.0F, 1.0F});
  for (std::size_t i = 6; i < 9; ++i) expectNear(cornerAt(mesh, i).normal, {0.0F, -1.0F, 0.0F});
  expectNear(glm::vec3(scene.materials.at(0).baseColor), glm::vec3(0.8F));
  EXPECT_EQ(scene.file.format, "STL (text)");
}

TEST(LoadStl, BinaryFilesMayBeginWithSolid) {
  const Scene scene = loadGood("solid_binary.stl");
  EXPECT_EQ(scene.meshes.at(0).indices.size(), 3U);
  EXPECT_EQ(scene.file.format, "STL (binary)");
  EXPECT_EQ(scene.warnings, Lines{});
}

TEST(LoadStl, MagicsColors) {
  const Scene scene = loadGood("magics.stl");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    const Vertex vertex = cornerAt(mesh, i);
    expectNear(glm::vec3(vertex.color),
               vertex.position.z < 1.0F ? glm::vec3(1.0F, 0.0F, 0.0F) : glm::vec3(0.0F, 1.0F, 0.0F));
    EXPECT_NEAR(vertex.color.a, 0.2F, 1e-3F);
  }
  EXPECT_EQ(scene.materials.at(0).alphaMode, AlphaMode::Blend);
}

TEST(LoadStl, MagicsPrefersTheMaterialAndKeepsTheAlphaOfTheColor) {
  const Scene scene = loadGood("magics_material.stl");
  expectNear(glm::vec3(cornerAt(scene.meshes.at(0), 0).color), {0.0F, 0.0F, 1.0F});
  EXPECT_NEAR(cornerAt(scene.meshes.at(0), 0).color.a, 0.2F, 1e-3F);
}

TEST(LoadStl, ViscamColors) {
  const Scene scene = loadGood("viscam.stl");
  const Mesh& mesh = scene.meshes.at(0);
  for (std::size_t i = 0; i < 6; ++i) {
    const Vertex vertex = cornerAt(mesh, i);
    expectNear(glm::vec3(vertex.color), vertex.position.z < 1.0F ? glm::vec3(0.0F, 0.0F, 1.0F) : glm::vec3(0.8F),
               1e-3F);
  }
  EXPECT_EQ(scene.materials.at(0).alphaMode, AlphaMode::Opaque);
}

TEST(LoadStl, LetterCaseLineEndsAndWideCharactersDoNotMatter) {
  for (const std::string name : {"uppercase.stl", "old_mac.stl", "one_line.stl", "utf16.stl"}) {
    SCOPED_TRACE(name);
    const Scene scene = loadGood(name);
    ASSERT_EQ(scene.meshes.at(0).indices.size(), 3U);
    expectNear(cornerAt(scene.meshes.at(0), 1).position, {1.0F, 0.0F, 0.0F});
    EXPECT_EQ(scene.warnings, Lines{});
  }
}

TEST(LoadStl, AllSolidsAreDrawnWhateverTheirNames) {
  const Scene scene = loadGood("solids.stl");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 6U);
  expectNear(cornerAt(mesh, 5).position, {0.0F, 1.0F, 1.0F});
  EXPECT_EQ(scene.warnings, Lines{"left out, since a corner is not finite: 1 of 3 facets"});
}

TEST(LoadStl, WhatIsFarAwayIsCentredInDoublePrecision) {
  const Scene scene = loadGood("far_away.stl");
  EXPECT_EQ(scene.origin, glm::dvec3(500000.75, 4649776.625, 10.5));
  expectNear(cornerAt(scene.meshes.at(0), 1).position, {0.5F, -0.5F, 0.0F});
}

TEST(LoadStl, AWrongCountOfFacetsGivesWayToTheSize) {
  const Scene zero = loadGood("count_zero.stl");
  EXPECT_EQ(zero.meshes.at(0).indices.size(), 6U);
  EXPECT_EQ(zero.warnings, Lines{"the STL header states 0 facets, but the file has room for 2: those are drawn"});
  const Scene large = loadGood("count_large.stl");
  EXPECT_EQ(large.meshes.at(0).indices.size(), 6U);
  EXPECT_EQ(large.warnings, Lines{"the STL header states 1000 facets, but the file has room for 2: those are drawn"});
  const Scene small = loadGood("count_small.stl");
  EXPECT_EQ(small.meshes.at(0).indices.size(), 3U);
  EXPECT_EQ(small.warnings,
            Lines{"the STL header states 1 facets, but the file has room for 2: the others are left out"});
}

// Corners at one place with one normal are one vertex again.
TEST(LoadStl, SmoothSurfacesShareTheirVertices) {
  const Scene scene = loadGood("ridge.stl");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 24U);
  EXPECT_EQ(*std::ranges::max_element(mesh.indices), 9U) << "ten places, each with one normal";
  for (std::size_t i = 0; i < 24; ++i) EXPECT_NEAR(cornerAt(mesh, i).normal.z, 0.0F, 1e-6F);
  // Between two panels of equal width the normal is their mean, weighted by the area around the corner.
  const glm::vec3 first(std::cos(0.2617994F), std::sin(0.2617994F), 0.0F);
  const glm::vec3 second(std::cos(0.7853982F), std::sin(0.7853982F), 0.0F);
  for (std::size_t i = 0; i < 24; ++i) {
    const Vertex vertex = cornerAt(mesh, i);
    if (std::abs(vertex.position.y - 0.5F) > 1e-5F) continue;
    // The lower corner has one triangle of the first panel and two of the second, the upper one two and one.
    const bool upper = vertex.position.z > 0.5F;
    expectNear(vertex.normal, glm::normalize(first * (upper ? 2.0F : 1.0F) + second * (upper ? 1.0F : 2.0F)), 1e-3F);
  }
}

TEST(LoadStl, TextIsReadInPartsAsInOne) {
  // Large enough for several threads; each facet is its own, so that the order of all shows.
  std::string text = "solid many\n";
  constexpr int facets = 40'000;
  for (int i = 0; i < facets; ++i) {
    const std::string x = std::to_string(i);
    text += "facet normal 0 0 1\nouter loop\nvertex " + x + " 0 0\nvertex " + x + ".5 0 0\nvertex " + x +
            " 1 0\nendloop\nendfacet\n";
  }
  const Scene scene = stlOf(text + "endsolid many\n");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 3U * facets);
  for (std::size_t i = 0; i < facets; i += 997)
    EXPECT_EQ(cornerAt(mesh, 3 * i + 1).position, glm::vec3(static_cast<float>(i) + 0.5F, 0.0F, 0.0F));
  try {
    stlOf(text + "facet\nouter loop\nvertex 0 0 0\nendloop\n");
    ADD_FAILURE();
  } catch (const LoadError& error) {
    EXPECT_EQ(std::string(error.what()), "line 280005: a loop ends without 3 vertices");
  }
}

TEST(LoadStl, FilesThatAreCutOffInTheirLastFacetAreDrawnWithoutIt) {
  const std::string facet =
      "facet normal 0 0 1\nouterloop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  for (const std::string& end : Lines{"facet normal 0", "facet\nouter loop\nvertex 0 0 1\nvertex 1",
                                      "facet\nouter loop\nvertex 0 0 1\nvertex 1 0 -"}) {
    const Scene scene = stlOf("solid a\n" + facet + end);
    EXPECT_EQ(scene.meshes.at(0).indices.size(), 3U) << end;
    EXPECT_EQ(scene.warnings, Lines{"the file ends inside a facet: the 1 before it are drawn"}) << end;
  }
  EXPECT_EQ(stlOf("solid a\n" + facet + "endsolid a\n").warnings, Lines{});
  std::string binary(80, ' ');
  binary += std::string("\2\0\0\0", 4) + std::string(99, '\0');
  const std::string one("\0\0\x80\x3f", 4);
  binary.replace(84 + 24, 4, one);
  binary.replace(84 + 40, 4, one);
  const Scene scene = stlOf(binary);
  EXPECT_EQ(scene.meshes.at(0).indices.size(), 3U);
  EXPECT_EQ(scene.warnings, Lines{"the STL header states 2 facets, but the file has room for 1: those are drawn"});
}

} // namespace
} // namespace vitrail::tool::test
