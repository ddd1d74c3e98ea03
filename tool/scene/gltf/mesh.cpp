// Turns one glTF primitive into a mesh: attributes, morph targets, skin, triangles, normals, tangents.
#include "mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "../load.h"
#include "../mesh_build.h"
#include "../message.h"
#include "accessor.h"
#include "skin.h"

namespace vitrail::tool {
namespace {

using AccessorIndices = std::map<std::string, int>;

float finiteOr(float value, float otherwise) { return std::isfinite(value) ? value : otherwise; }

// The vertices of one primitive as they come in: one reader call fills one member of each.
class VertexReader {
 public:
  VertexReader(const GltfDocument& document, std::string where) : document_(document), where_(std::move(where)) {}

  std::vector<Vertex> read(const AccessorIndices& attributes, const GltfMaterial& material) {
    const auto position = static_cast<std::size_t>(attributes.at("POSITION"));
    const std::vector<glm::vec4> positions = readVectors(document_, position, 3, 3, "POSITION");
    vertices_.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      for (int c = 0; c < 3; ++c)
        if (!std::isfinite(positions[i][c]))
          throw LoadError(
              fmt::format("{}: position {} of {} is not finite", where_, i, accessorName(document_, position)));
      vertices_[i].position = glm::vec3(positions[i]);
    }
    each(attributes, "NORMAL", 3, 3, [](Vertex& vertex, const glm::vec4& value) { vertex.normal = glm::vec3(value); });
    each(attributes, "TANGENT", 4, 4, [](Vertex& vertex, const glm::vec4& value) { vertex.tangent = value; });
    each(attributes, fmt::format("TEXCOORD_{}", material.texCoordSets[0]), 2, 2,
         [](Vertex& vertex, const glm::vec4& value) { vertex.texCoord0 = glm::vec2(value); });
    each(attributes, fmt::format("TEXCOORD_{}", material.texCoordSets[1]), 2, 2,
         [](Vertex& vertex, const glm::vec4& value) { vertex.texCoord1 = glm::vec2(value); });
    each(attributes, "COLOR_0", 3, 4, [](Vertex& vertex, const glm::vec4& value) { vertex.color = value; });
    return std::move(vertices_);
  }

  // Adds `weight` times the displacements of one morph target.
  void morph(const AccessorIndices& target, const GltfMaterial& material, float weight, std::vector<Vertex>& vertices) {
    vertices_ = std::move(vertices);
    each(target, "POSITION", 3, 3,
         [=](Vertex& vertex, const glm::vec4& value) { vertex.position += weight * glm::vec3(value); });
    each(target, "NORMAL", 3, 3,
         [=](Vertex& vertex, const glm::vec4& value) { vertex.normal += weight * glm::vec3(value); });
    each(target, "TANGENT", 3, 3,
         [=](Vertex& vertex, const glm::vec4& value) { vertex.tangent += glm::vec4(weight * glm::vec3(value), 0.0F); });
    each(target, fmt::format("TEXCOORD_{}", material.texCoordSets[0]), 2, 2,
         [=](Vertex& vertex, const glm::vec4& value) { vertex.texCoord0 += weight * glm::vec2(value); });
    each(target, fmt::format("TEXCOORD_{}", material.texCoordSets[1]), 2, 2,
         [=](Vertex& vertex, const glm::vec4& value) { vertex.texCoord1 += weight * glm::vec2(value); });
    each(
        target, "COLOR_0", 3, 4, [=](Vertex& vertex, const glm::vec4& value) { vertex.color += weight * value; },
        glm::vec4(0.0F));
    vertices = std::move(vertices_);
  }

 private:
  template <typename Set>
  void each(const AccessorIndices& attributes, const std::string& name, int least, int most, Set set,
            const glm::vec4& fill = glm::vec4(1.0F)) {
    const auto attribute = attributes.find(name);
    if (attribute == attributes.end()) return;
    const auto accessor = static_cast<std::size_t>(attribute->second);
    if (accessorCount(document_, accessor) != vertices_.size())
      throw LoadError(fmt::format("{}: has {} positions, but {} of {}", where_, vertices_.size(),
                                  accessorCount(document_, accessor), name));
    const std::vector<glm::vec4> values = readVectors(document_, accessor, least, most, name, fill);
    for (std::size_t i = 0; i < vertices_.size(); ++i) set(vertices_[i], values[i]);
  }

  const GltfDocument& document_;
  std::string where_;
  std::vector<Vertex> vertices_;
};

void repairAttributes(std::vector<Vertex>& vertices, const std::string& where) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Vertex& vertex = vertices[i];
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(vertex.position[c]))
        throw LoadError(fmt::format("{}: vertex {} is not at a finite place in its rest pose", where, i));
    for (int c = 0; c < 2; ++c) {
      vertex.texCoord0[c] = finiteOr(vertex.texCoord0[c], 0.0F);
      vertex.texCoord1[c] = finiteOr(vertex.texCoord1[c], 0.0F);
    }
    for (int c = 0; c < 4; ++c) vertex.color[c] = std::max(finiteOr(vertex.color[c], 1.0F), 0.0F);
    vertex.color.a = std::min(vertex.color.a, 1.0F);
  }
}

std::optional<Topology> topologyOf(int mode, const std::string& where) {
  switch (mode) {
    case TINYGLTF_MODE_TRIANGLES:
      return Topology::Triangles;
    case TINYGLTF_MODE_TRIANGLE_STRIP:
      return Topology::Strip;
    case TINYGLTF_MODE_TRIANGLE_FAN:
      return Topology::Fan;
    case TINYGLTF_MODE_POINTS:
    case TINYGLTF_MODE_LINE:
    case TINYGLTF_MODE_LINE_LOOP:
    case TINYGLTF_MODE_LINE_STRIP:
      return std::nullopt;
    default:
      throw LoadError(fmt::format("{}: mode is {}, which is none", where, mode));
  }
}

// The triangle list of a primitive with that many vertices.
std::vector<std::uint32_t> readTriangles(const GltfDocument& document, const tinygltf::Primitive& primitive,
                                         Topology topology, std::size_t vertexCount, const std::string& where) {
  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0) {
    indices = readIndices(document, static_cast<std::size_t>(primitive.indices));
    for (std::size_t i = 0; i < indices.size(); ++i)
      if (indices[i] >= vertexCount)
        throw LoadError(
            fmt::format("{}: index {} is {}, but there are {} vertices", where, i, indices[i], vertexCount));
  } else {
    indices.resize(vertexCount);
    std::iota(indices.begin(), indices.end(), 0U);
  }
  return triangleList(indices, topology);
}

// Keeps of the vertices what the mesh has. Tangents mean nothing without the normals that they were made for.
void finish(Mesh& mesh, const std::vector<Vertex>& vertices, const AccessorIndices& attributes,
            const Material& material) {
  for (const Vertex& vertex : vertices) mesh.add(vertex);
  std::vector<glm::vec3> normals;
  std::vector<glm::vec4> tangents;
  const bool hasNormals = attributes.contains("NORMAL");
  const bool hasTangents = hasNormals && attributes.contains("TANGENT");
  if (hasNormals)
    for (const Vertex& vertex : vertices) normals.push_back(vertex.normal);
  if (hasTangents)
    for (const Vertex& vertex : vertices) tangents.push_back(vertex.tangent);
  mesh.normals.clear();
  mesh.tangents.clear();
  dropDegenerateTriangles(mesh);
  if (hasNormals) setRepairedNormals(mesh, std::move(normals));
  if (hasTangents) setRepairedTangents(mesh, tangents);
  dropUnusedVertices(mesh);
  const bool mapped = material.normalTexture.image >= 0;
  if (hasTangents || (!mapped && material.anisotropy <= 0.0F)) return;
  if (!hasNormals) makeFlatNormals(mesh);
  makeTangents(mesh, mapped ? material.normalTexture : material.anisotropyTexture);
}

} // namespace

// What a file makes stays in proportion to its size, and below what 32-bit indices reach, or a small file that shows
// one accessor many times could fill the memory.
GltfMeshReader::GltfMeshReader(const GltfDocument& document)
    : document_(document), budget_(std::min<std::uint64_t>(2'000'000 + 64 * document.totalBytes, 0xfffffffe)) {}

void GltfMeshReader::take(std::uint64_t elements) {
  if (elements > budget_)
    throw LoadError(fmt::format("the file's {} bytes make too many vertices and indices", document_.totalBytes));
  budget_ -= elements;
}

Mesh GltfMeshReader::read(std::size_t mesh, std::size_t primitive, const GltfMaterial& material, const GltfPose& pose) {
  const tinygltf::Mesh& parent = document_.model.meshes[mesh];
  const tinygltf::Primitive& source = parent.primitives[primitive];
  const std::string where = fmt::format("{} primitive {}", objectName("mesh", mesh, parent.name), primitive);
  const std::optional<Topology> topology = topologyOf(source.mode, where);
  Mesh result;
  if (!topology || !source.attributes.contains("POSITION")) return result;

  VertexReader reader(document_, where);
  std::vector<Vertex> vertices = reader.read(source.attributes, material);
  take(vertices.size());
  for (std::size_t i = 0; i < std::min(source.targets.size(), pose.weights.size()); ++i)
    if (pose.weights[i] != 0.0)
      reader.morph(source.targets[i], material, static_cast<float>(pose.weights[i]), vertices);
  result.indices = readTriangles(document_, source, *topology, vertices.size(), where);
  take(result.indices.size());
  if (pose.skin) applySkin(document_, pose.nodes, *pose.skin, source, where, vertices, result.indices);
  repairAttributes(vertices, where);
  finish(result, vertices, source.attributes, material.material);
  return result;
}

bool isSkinned(const tinygltf::Primitive& primitive, const tinygltf::Node& node) {
  return node.skin >= 0 && primitive.attributes.contains("JOINTS_0") && primitive.attributes.contains("WEIGHTS_0");
}

} // namespace vitrail::tool
