// Compressed geometry in glTF files: what Draco and meshoptimizer hold is what plain accessors would.
#include <string>

#include <gtest/gtest.h>

#include "load_good.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"
#include "scene/load.h"
#include "scene/read_file.h"

namespace vitrail::tool {
namespace {

// The corners of a mesh's triangles, in order.
std::vector<Vertex> cornerVertices(const Mesh& mesh) {
  std::vector<Vertex> vertices;
  for (const std::uint32_t index : mesh.indices) vertices.push_back(mesh.vertex(index));
  return vertices;
}

// The triangles 0 1 2 and 2 1 3 of tests/corpus/streams.py, from whichever corner each begins.
void expectQuad(const Mesh& mesh, float tolerance) {
  const std::vector<Vertex> found = cornerVertices(mesh);
  ASSERT_EQ(found.size(), 6U);
  const std::array<glm::vec3, 4> places{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5F}}};
  std::array<int, 4> seen{};
  for (std::size_t i = 0; i < 6; i += 3) {
    const glm::vec3 up =
        glm::cross(found[i + 1].position - found[i].position, found[i + 2].position - found[i].position);
    EXPECT_GT(up.z, 0.9F) << "wound the other way round";
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t p = 0; p < 4; ++p)
        if (glm::distance(found[i + c].position, places[p]) < tolerance) ++seen[p];
  }
  EXPECT_EQ(seen, (std::array<int, 4>{1, 2, 2, 1}));
}

TEST(LoadCompressed, DracoOfBothMethods) {
  for (const auto& [name, tolerance] : {std::pair{"draco_edgebreaker.gltf", 1e-3F}, {"draco_sequential.gltf", 1e-6F}}) {
    SCOPED_TRACE(name);
    const Scene scene = loadGood(name);
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.meshes.size(), 1U);
    expectQuad(scene.meshes[0], tolerance);
    for (const Vertex& vertex : cornerVertices(scene.meshes[0])) {
      expectNear(vertex.normal, {0, 0, 1}, 0.02F);
      EXPECT_NEAR(vertex.texCoord0.x, vertex.position.x, 2e-3F);
      EXPECT_NEAR(vertex.texCoord0.y, 1.0F - vertex.position.y, 2e-3F);
      if (vertex.position.x > 0.5F && vertex.position.y < 0.5F) {
        EXPECT_NEAR(glm::distance(vertex.color, glm::vec4(0, 1, 0, 0.2F)), 0.0F, 1e-3F);
      }
    }
  }
}

TEST(LoadCompressed, DamagedDracoDataLeaveTheAccessorsOwn) {
  const Scene scene = loadGood("draco_damaged_with_data.gltf");
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(scene.warnings[0].starts_with("mesh 0 primitive 0: KHR_draco_mesh_compression: the data are damaged"))
      << scene.warnings[0];
  EXPECT_TRUE(scene.warnings[0].ends_with("; the uncompressed data beside it are drawn"));
  expectNear(cornerVertices(scene.meshes.at(0)).at(1).position, {1, 0, 0});
}

TEST(LoadCompressed, MeshoptTrianglesAndOctahedralNormals) {
  for (const char* name : {"meshopt.gltf", "meshopt_khronos.gltf"}) {
    SCOPED_TRACE(name);
    const Scene scene = loadGood(name);
    EXPECT_TRUE(scene.warnings.empty());
    expectQuad(scene.meshes.at(0), 1e-6F);
    for (const Vertex& vertex : cornerVertices(scene.meshes[0])) {
      if (vertex.position == glm::vec3(0, 1, 0)) expectNear(vertex.normal, {0, 0.6F, 0.8F}, 0.02F);
    }
  }
}

TEST(LoadCompressed, MeshoptStripsAndExponents) {
  const std::vector<Vertex> found = cornerVertices(loadGood("meshopt_filters.gltf").meshes.at(0));
  ASSERT_EQ(found.size(), 6U);
  expectNear(found[1].position, {8, 0, 0});
  expectNear(found[2].position, {0, -4, 0});
  expectNear(found[4].position, {3, 0.25F, 100});
}

TEST(LoadCompressed, MeshoptQuaternions) {
  const std::filesystem::path path = std::filesystem::path(VITRAIL_TEST_CORPUS) / "good" / "meshopt_rotations.gltf";
  const std::vector<std::byte> file = readFile(path);
  const GltfDocument document = openGltf(MappedFile(file), path.parent_path());
  const std::vector<glm::vec4> rotations = readVectors(document, 1, 4, 4, "rotations");
  const float h = std::sqrt(0.5F);
  const std::array<glm::vec4, 4> expected{{{0, 0, 0, 1}, {0, 0, h, h}, {h, 0, 0, h}, {0.5F, 0.5F, -0.5F, 0.5F}}};
  ASSERT_EQ(rotations.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(std::abs(glm::dot(rotations[i], expected[i])), 1.0F, 1e-2F) << "rotation " << i;
}

} // namespace
} // namespace vitrail::tool
