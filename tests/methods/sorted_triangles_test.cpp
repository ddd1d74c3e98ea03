// What the method sorted-triangles promises beyond the table of methods_test.cpp: more changes of material than it
// records in one submission.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "../reference/test_scenes.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

constexpr std::uint32_t kTriangles = 66'000; // a submission has 65,536 draws
constexpr std::uint32_t kColumns = 60;
constexpr std::uint32_t kRows = 40;

// Halves of the cells of a grid, at depths of their own that rise with their number. Neighbours in depth are of
// different objects, so each is a draw of its own; the last cover others, so none of them may be left out.
Scene interleavedTriangles() {
  Scene scene;
  std::array<Mesh, 2> meshes;
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    Mesh& mesh = meshes.at(i % 2);
    const std::uint32_t cell = i / 2 % (kColumns * kRows);
    const glm::vec2 low(-1.2F + 0.04F * static_cast<float>(cell % kColumns),
                        -0.8F + 0.04F * static_cast<float>(cell / kColumns));
    const auto hue = static_cast<float>(i / 400 % 5); // so that one more or less shows
    const float z = -6.0F + 12.0F * static_cast<float>(i) / static_cast<float>(kTriangles);
    const auto base = static_cast<std::uint32_t>(mesh.vertexCount());
    for (const glm::vec2 corner : {glm::vec2(0.0F, 0.0F), glm::vec2(0.1F, 0.0F), glm::vec2(0.0F, 0.1F)}) {
      Vertex vertex;
      vertex.position = glm::vec3(low + corner, z);
      vertex.color = glm::vec4(0.25F * hue, 1.0F - 0.25F * hue, 0.5F, 1.0F);
      mesh.add(vertex);
    }
    mesh.indices.insert(mesh.indices.end(), {base, base + 1, base + 2});
  }
  for (std::uint32_t i = 0; i < 2; ++i) {
    scene.meshes.push_back(meshes.at(i));
    scene.materials.push_back(reference::unlitMaterial(i == 0 ? glm::vec4(0.9F, 0.2F, 0.1F, 0.6F) //
                                                              : glm::vec4(0.1F, 0.4F, 0.9F, 0.5F)));
    scene.draws.push_back({.mesh = i, .material = i});
  }
  return scene;
}

TEST_F(GpuTest, SortedTrianglesMayChangeMaterialMoreOftenThanASubmissionHolds) {
  const Scene scene = interleavedTriangles();
  RenderOptions picture;
  picture.width = 72;
  picture.height = 48;
  picture.view = reference::straightView();
  MethodOptions sorted;
  sorted.name = "sorted-triangles";
  MethodOptions lists;
  lists.nodes = VITRAIL_NODE_HDR;
  const Picture drawn = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, sorted).picture;
  const Picture exact = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, lists).picture;
  int largest = 0;
  for (std::size_t i = 0; i < drawn.rgba.size(); ++i) {
    largest = std::max(largest, std::abs(int{drawn.rgba[i]} - exact.rgba[i]));
  }
  EXPECT_LE(largest, 2); // 16-bit floats round after each surface
}

} // namespace
} // namespace vitrail::tool::test
