#include "scene.h"

#include <map>
#include <utility>

#include "tool/scene/builtin/builtin.h"
#include "tool/scene/camera.h"

namespace vitrail::tests::figures {

namespace {

constexpr std::uint32_t kCells = 24; // of the pane, along each side

// A square sheet of triangles that share all their edges.
tool::Scene makePane() {
  tool::Scene scene;
  tool::Mesh mesh;
  for (std::uint32_t i = 0; i <= kCells; ++i) {
    for (std::uint32_t k = 0; k <= kCells; ++k) {
      tool::Vertex vertex;
      vertex.position = {static_cast<float>(k) / kCells - 0.5F, static_cast<float>(i) / kCells - 0.5F, 0.0F};
      mesh.add(vertex);
    }
  }
  for (std::uint32_t i = 0; i < kCells; ++i) {
    for (std::uint32_t k = 0; k < kCells; ++k) {
      const std::uint32_t corner = i * (kCells + 1) + k;
      for (const std::uint32_t at : {0U, 1U, kCells + 2, 0U, kCells + 2, kCells + 1})
        mesh.indices.push_back(corner + at);
    }
  }
  tool::Material material;
  material.alphaMode = tool::AlphaMode::Blend;
  material.unlit = true;
  material.baseColor = {0.1F, 0.4F, 0.8F, 0.5F};
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(std::move(material));
  scene.draws.push_back({0, 0, glm::mat4(1.0F)});
  return scene;
}

Instance instanceOf(const tool::Draw& draw, const tool::Material& material) {
  const glm::mat4 rows = glm::transpose(draw.transform);
  return {{rows[0], rows[1], rows[2]}, material.baseColor, material.unlit ? -1.0F : material.roughness};
}

void addMesh(Geometry& geometry, const tool::Mesh& mesh) {
  for (const tool::Vertex& vertex : mesh.vertices()) geometry.vertices.push_back({vertex.position, vertex.normal});
  geometry.indices.insert(geometry.indices.end(), mesh.indices.begin(), mesh.indices.end());
}

} // namespace

Geometry makeGeometry(std::string_view name, std::uint32_t width, std::uint32_t height) {
  const tool::Scene scene = name == "pane" ? makePane() : tool::makeBuiltinScene(name, {});
  Geometry geometry;
  std::map<std::pair<bool, std::uint32_t>, std::vector<Instance>> instances; // opaque ones first
  for (const tool::Draw& draw : scene.draws) {
    const tool::Material& material = scene.materials[draw.material];
    instances[{tool::isTransparent(material), draw.mesh}].push_back(instanceOf(draw, material));
  }
  for (const auto& [key, some] : instances) {
    const tool::Mesh& mesh = scene.meshes[key.second];
    geometry.groups.push_back(
        {key.first, static_cast<std::uint32_t>(geometry.indices.size()),
         static_cast<std::uint32_t>(mesh.indices.size()), static_cast<std::int32_t>(geometry.vertices.size()),
         static_cast<std::uint32_t>(geometry.instances.size()), static_cast<std::uint32_t>(some.size())});
    addMesh(geometry, mesh);
    geometry.instances.insert(geometry.instances.end(), some.begin(), some.end());
  }
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  geometry.frame = tool::makeFrameData(tool::frameScene(scene, {}, aspect), width, height, scene.origin);
  geometry.sky = scene.background && scene.background->kind == tool::Background::Kind::Sky;
  return geometry;
}

} // namespace vitrail::tests::figures
