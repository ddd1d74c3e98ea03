// The simple bodies and the teapot: closed, wound and sized as they say.
#include "scene/builtin/shapes.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "mesh_checks.h"
#include "scene/builtin/teapot.h"

namespace vitrail::tool::test {
namespace {

constexpr double pi = std::numbers::pi;

void expectClosed(const Mesh& mesh, double volume, double tolerance) {
  EXPECT_EQ(meshFault(mesh), "");
  EXPECT_EQ(openEdges(mesh), 0U);
  EXPECT_NEAR(signedVolume(mesh), volume, tolerance * volume);
}

TEST(Shapes, SphereIsClosedAndRound) {
  const Mesh sphere = uvSphere(64, 32);
  expectClosed(sphere, 4.0 / 3.0 * pi, 0.01);
  EXPECT_EQ(sphere.indices.size() / 3, 64U * 31U * 2U);
  for (const Vertex& vertex : sphere.vertices()) {
    EXPECT_NEAR(glm::length(vertex.position), 1.0F, 1e-6F);
    if (std::abs(vertex.position.y) < 0.999F) {
      EXPECT_NEAR(glm::dot(vertex.position, vertex.normal), 1.0F, 1e-6F);
    }
  }
}

TEST(Shapes, SmallestSphereIsClosed) {
  const Mesh sphere = uvSphere(3, 2);
  EXPECT_EQ(meshFault(sphere), "");
  EXPECT_EQ(openEdges(sphere), 0U);
  EXPECT_EQ(sphere.indices.size() / 3, 6U);
}

TEST(Shapes, TextureRunsRightAndDownFromOutside) {
  for (const Vertex& vertex : uvSphere(32, 16).vertices()) {
    if (std::abs(vertex.position.y) > 0.999F) continue;
    EXPECT_NEAR(vertex.texCoord0.y, std::acos(vertex.position.y) / pi, 1e-3);
    const float angle = vertex.texCoord0.x * 2.0F * std::numbers::pi_v<float>;
    EXPECT_NEAR(vertex.tangent.x, std::cos(angle), 1e-4F);
    EXPECT_NEAR(vertex.tangent.z, -std::sin(angle), 1e-4F);
  }
}

TEST(Shapes, CapsuleIsACylinderWithHalfSpheres) {
  expectClosed(capsule(0.5F, 0.5F, 1.0F, 64, 16), pi * 0.25 * 2.0 + 4.0 / 3.0 * pi * 0.125, 0.01);
  const Bounds bounds = boundsOf(capsule(0.5F, 0.5F, 1.0F, 64, 16));
  EXPECT_FLOAT_EQ(bounds.max.y, 1.5F);
  EXPECT_FLOAT_EQ(bounds.min.y, -1.5F);
}

TEST(Shapes, TaperedCapsuleTouchesBothSpheres) {
  const Mesh mesh = capsule(0.2F, 0.6F, 1.0F, 48, 12);
  EXPECT_EQ(meshFault(mesh), "");
  EXPECT_EQ(openEdges(mesh), 0U);
  for (const Vertex& vertex : mesh.vertices()) {
    const float top = glm::distance(vertex.position, glm::vec3(0.0F, 1.0F, 0.0F));
    const float bottom = glm::distance(vertex.position, glm::vec3(0.0F, -1.0F, 0.0F));
    EXPECT_TRUE(std::abs(top - 0.2F) < 1e-5F || std::abs(bottom - 0.6F) < 1e-5F);
  }
}

TEST(Shapes, DiscIsClosed) { expectClosed(disc(2.0F, 0.1F, 0.02F, 256), pi * 4.0 * 0.2, 0.01); }

TEST(Shapes, TorusIsClosed) { expectClosed(torus(1.0F, 0.2F, 128, 64), 2.0 * pi * pi * 0.04, 0.01); }

TEST(Shapes, QuadFacesForward) {
  const Mesh mesh = quad(2.0F, 3.0F);
  EXPECT_EQ(meshFault(mesh), "");
  EXPECT_EQ(mesh.indices.size(), 6U);
  EXPECT_EQ(boundsOf(mesh).max, glm::vec3(2.0F, 3.0F, 0.0F));
  EXPECT_EQ(mesh.vertex(0).position, glm::vec3(-2.0F, 3.0F, 0.0F));
  EXPECT_EQ(mesh.vertex(0).texCoord0, glm::vec2(0.0F));
}

TEST(Shapes, TubeIsClosedAndAsThickAsItsRadius) {
  std::vector<glm::vec3> curve;
  for (int i = 0; i <= 40; ++i) {
    const float t = 0.2F * static_cast<float>(i);
    curve.emplace_back(std::cos(t), 0.2F * t, std::sin(t));
  }
  const std::vector<float> radii(curve.size(), 0.05F);
  const Mesh mesh = tube(curve, radii, 7);
  EXPECT_EQ(meshFault(mesh), "");
  EXPECT_EQ(openEdges(mesh), 0U);
  EXPECT_GT(signedVolume(mesh), 0.0);
  for (std::size_t i = 0; i < curve.size() * 7; ++i) {
    EXPECT_NEAR(glm::distance(mesh.vertex(i).position, curve[i / 7]), 0.05F, 1e-6F);
  }
}

TEST(Shapes, TubesRunInAnyDirection) {
  for (const glm::vec3 end : {glm::vec3(0, 1, 0), {0, -1, 0}, {1, 0, 0}, {0, 0, -1}, {0.1F, 1, 0.1F}}) {
    const std::array<glm::vec3, 2> curve{glm::vec3(0.0F), end};
    const std::array<float, 2> radii{0.1F, 0.05F};
    const Mesh mesh = tube(curve, radii, 5);
    EXPECT_EQ(meshFault(mesh), "");
    EXPECT_EQ(openEdges(mesh), 0U);
  }
}

TEST(Shapes, AppendedPartsKeepTheirTriangles) {
  Mesh mesh = quad(1.0F, 1.0F);
  append(mesh, uvSphere(8, 4));
  EXPECT_EQ(meshFault(mesh), "");
  EXPECT_EQ(mesh.vertexCount(), 4U + 9U * 5U);
  EXPECT_EQ(mesh.indices[6], uvSphere(8, 4).indices[0] + 4);
}

TEST(Teapot, HasNewellsSize) {
  const Bounds bounds = boundsOf(teapot(16));
  EXPECT_FLOAT_EQ(bounds.min.y, 0.0F);
  EXPECT_FLOAT_EQ(bounds.max.y, 3.15F);
  EXPECT_FLOAT_EQ(bounds.min.z, -2.0F);
  EXPECT_FLOAT_EQ(bounds.max.z, 2.0F);
  EXPECT_FLOAT_EQ(bounds.min.x, -3.0F);
  EXPECT_NEAR(bounds.max.x, 3.434F, 0.01F); // the curve of the spout's lip, inside its control points
}

// Open are the rim's and the lid's inner edges and both ends of handle and spout; patches meet everywhere else.
TEST(Teapot, PatchesMeetWithoutCracks) {
  for (const std::uint32_t steps : {2U, 5U, 12U}) {
    EXPECT_EQ(openEdges(teapot(steps)), 16U * steps);
  }
}

TEST(Teapot, NormalsPointOutward) {
  const Mesh mesh = teapot(12);
  EXPECT_EQ(meshFault(mesh), "");
  for (const Vertex& vertex : mesh.vertices()) {
    const glm::vec3 across(vertex.position.x, 0.0F, vertex.position.z);
    const bool onBody = glm::length(across) > 1.6F && glm::length(across) < 2.001F && std::abs(across.z) > 0.8F;
    if (onBody) {
      EXPECT_GT(glm::dot(across, vertex.normal), 0.0F);
    }
    if (vertex.position.y == 3.15F) {
      EXPECT_NEAR(vertex.normal.y, 1.0F, 0.01F);
    }
    if (vertex.position.y == 0.0F) {
      EXPECT_NEAR(vertex.normal.y, -1.0F, 0.01F);
    }
  }
}

} // namespace
} // namespace vitrail::tool::test
