// The values that OBJ files load to, and how polygons are split.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "load_good.h"
#include "scene/load.h"
#include "scene/plain/polygon.h"

namespace vitrail::tool {
namespace {

glm::vec3 areaVector(const Mesh& mesh, std::size_t triangle) {
  const auto corner = [&](std::size_t c) { return mesh.positions[mesh.indices[3 * triangle + c]]; };
  return glm::cross(corner(1) - corner(0), corner(2) - corner(0)) * 0.5F;
}

float area(const Mesh& mesh) {
  float sum = 0.0F;
  for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i) sum += glm::length(areaVector(mesh, i));
  return sum;
}

constexpr float linearHalf = 0.21404114F; // 0.5 on the sRGB curve, in linear light

const Material& materialNamed(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.materials, name, &Material::name);
  if (found == scene.materials.end()) throw std::out_of_range(name);
  return *found;
}

TEST(LoadObj, MaterialsBecomeTranslucentByFactorAndByTexture) {
  const Scene scene = loadGood("box.obj");
  const Material& glass = materialNamed(scene, "glass");
  EXPECT_EQ(glass.alphaMode, AlphaMode::Blend);
  EXPECT_TRUE(glass.doubleSided);
  EXPECT_EQ(glass.metallic, 0.0F);
  expectNear(glm::vec3(glass.baseColor), {1.0F, linearHalf, 0.0F});
  EXPECT_EQ(glass.baseColor.a, 0.25F);
  const Material& cut = materialNamed(scene, "cut\\out");
  EXPECT_EQ(cut.alphaMode, AlphaMode::Blend) << "its texture has translucent pixels";
  ASSERT_EQ(cut.baseColorTexture.image, 0);
  EXPECT_EQ(scene.images.at(0).rgba.at(7), 128);
  EXPECT_EQ(materialNamed(scene, "fog").baseColor.a, 0.25F) << "Tr is what d lacks to 1";
}

TEST(LoadObj, FacesTurnToTheirNormals) {
  const Scene scene = loadGood("box.obj");
  for (const Draw& draw : scene.draws) {
    if (scene.materials[draw.material].name != "glass") continue;
    const Mesh& mesh = scene.meshes[draw.mesh];
    ASSERT_EQ(mesh.indices.size(), 6U);
    expectNear(mesh.vertex(0).normal, {0.0F, 0.0F, -1.0F});
    for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(areaVector(mesh, i).z, 0.0F);
  }
}

TEST(LoadObj, TextureCoordinatesGrowDownwards) {
  const Scene scene = loadGood("box.obj");
  bool found = false;
  for (const Mesh& mesh : scene.meshes)
    for (const Vertex& vertex : mesh.vertices()) found = found || vertex.texCoord0 == glm::vec2(1.0F, 0.75F);
  EXPECT_TRUE(found);
}

TEST(LoadObj, LinesGoOnAfterABackslashAndNegativeIndicesCountBackwards) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 \\\n 1 0\nf -3 -2 \\\r\n -1\nv 9 9 9\n";
  const Scene scene = loadObj(std::as_bytes(std::span(text)), {});
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.vertexCount(), 3U);
  expectNear(mesh.vertex(2).position, {0.0F, 1.0F, 0.0F});
  expectNear(mesh.vertex(0).normal, {0.0F, 0.0F, 1.0F});
}

TEST(LoadObj, VertexColors) {
  const Scene scene = loadGood("vertex_colors.obj");
  expectNear(glm::vec3(scene.meshes.at(0).vertex(0).color), {1.0F, linearHalf, 0.0F}, kColorTolerance);
  EXPECT_EQ(scene.materials.at(0).baseColor, glm::vec4(1.0F));
}

TEST(AddPolygon, ConvexAndConcavePolygonsKeepTheirWindingInAnyPlane) {
  const std::vector<glm::vec2> arrow{{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}};
  for (int plane = 0; plane < 3; ++plane)
    for (const bool reversed : {false, true}) {
      Mesh mesh;
      std::vector<std::uint32_t> outline;
      for (const glm::vec2& p : arrow) {
        Vertex vertex;
        vertex.position[(plane + 1) % 3] = p.x;
        vertex.position[(plane + 2) % 3] = p.y;
        outline.push_back(static_cast<std::uint32_t>(mesh.vertexCount()));
        mesh.add(vertex);
      }
      if (reversed) std::ranges::reverse(outline);
      addPolygon(outline, mesh.positions, mesh.indices);
      ASSERT_EQ(mesh.indices.size(), 9U);
      EXPECT_NEAR(area(mesh), 10.0F, 1e-4F);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_GT(areaVector(mesh, i)[plane] * (reversed ? -1.0F : 1.0F), 0.0F);
    }
}

TEST(AddPolygon, FewerThanThreeCornersAreNothing) {
  const std::vector<glm::vec3> vertices(2);
  const std::vector<std::uint32_t> corners{0, 1};
  std::vector<std::uint32_t> triangles;
  addPolygon(corners, vertices, triangles);
  EXPECT_TRUE(triangles.empty());
}

} // namespace
} // namespace vitrail::tool
