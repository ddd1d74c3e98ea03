// Turns one glTF primitive into a mesh: attributes, morph targets, skin, triangles, normals, tangents.
#include "mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
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

glm::vec4 repairedColor(glm::vec4 color) {
  for (int c = 0; c < 4; ++c) color[c] = std::max(finiteOr(color[c], 1.0F), 0.0F);
  color.a = std::min(color.a, 1.0F);
  return color;
}

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

// Reads the attributes of a primitive in its rest pose straight into a mesh's arrays. Normals and tangents come last,
// when it has its triangles.
class MeshArrays {
 public:
  MeshArrays(const GltfDocument& document, const tinygltf::Primitive& primitive, const std::string& where, Mesh& mesh)
      : document_(document), attributes_(primitive.attributes), where_(where), mesh_(mesh) {}

  void readPlaces(const GltfMaterial& material) {
    const auto position = static_cast<std::size_t>(attributes_.at("POSITION"));
    visitVectors(document_, position, 3, 3, "POSITION", [&](std::size_t first, std::span<const glm::vec4> part) {
      // Only now it is known that the file has as many as it states.
      if (first == 0) mesh_.positions.resize(accessorCount(document_, position));
      for (std::size_t i = 0; i < part.size(); ++i) {
        if (!std::isfinite(part[i].x) || !std::isfinite(part[i].y) || !std::isfinite(part[i].z))
          throw LoadError(
              fmt::format("{}: position {} of {} is not finite", where_, first + i, accessorName(document_, position)));
        mesh_.positions[first + i] = glm::vec3(part[i]);
      }
    });
    const auto coordinates = [](const glm::vec4& v) { return glm::vec2(finiteOr(v.x, 0.0F), finiteOr(v.y, 0.0F)); };
    each(fmt::format("TEXCOORD_{}", material.texCoordSets[0]), 2, 2, mesh_.texCoords0, coordinates);
    each(fmt::format("TEXCOORD_{}", material.texCoordSets[1]), 2, 2, mesh_.texCoords1, coordinates);
    each("COLOR_0", 3, 4, mesh_.colors, [](const glm::vec4& color) { return packColor(repairedColor(color)); });
    const std::uint64_t white = packColor(glm::vec4(1.0F));
    if (std::ranges::all_of(mesh_.colors, [white](std::uint64_t color) { return color == white; })) mesh_.colors = {};
  }

  // Tangents mean nothing without the normals that they were made for.
  void readDirections() {
    bool complete = true;
    each("NORMAL", 3, 3, mesh_.normals, [&complete](const glm::vec4& value) {
      const double length = glm::length(glm::dvec3(value));
      const bool usable = length > 0.0 && std::isfinite(length);
      complete = complete && usable;
      return usable ? packDirection(glm::vec3(glm::dvec3(value) / length)) : 0U;
    });
    // Lines and points have no plane that a normal could be mended with: one that is none leaves all of them unlit.
    const bool triangles = mesh_.primitive == Primitive::Triangles;
    if (!triangles && !complete) mesh_.normals.clear();
    if (triangles && !complete) {
      std::vector<glm::vec3> normals;
      each("NORMAL", 3, 3, normals, [](const glm::vec4& value) { return glm::vec3(value); });
      setRepairedNormals(mesh_, std::move(normals));
    }
    if (mesh_.normals.empty() || !triangles) return;
    std::vector<glm::vec4> tangents;
    each("TANGENT", 4, 4, tangents, [](const glm::vec4& value) { return value; });
    if (!tangents.empty()) setRepairedTangents(mesh_, tangents);
  }

 private:
  template <typename Value, typename Convert>
  void each(const std::string& name, int least, int most, std::vector<Value>& values, Convert convert) {
    const auto attribute = attributes_.find(name);
    if (attribute == attributes_.end()) return;
    const auto accessor = static_cast<std::size_t>(attribute->second);
    if (accessorCount(document_, accessor) != mesh_.positions.size())
      throw LoadError(fmt::format("{}: has {} positions, but {} of {}", where_, mesh_.positions.size(),
                                  accessorCount(document_, accessor), name));
    values.resize(mesh_.positions.size());
    visitVectors(
        document_, accessor, least, most, name,
        [&](std::size_t first, std::span<const glm::vec4> part) {
          for (std::size_t i = 0; i < part.size(); ++i) values[first + i] = convert(part[i]);
        },
        glm::vec4(1.0F));
  }

  const GltfDocument& document_;
  const AccessorIndices& attributes_;
  const std::string& where_;
  Mesh& mesh_;
};

void repairAttributes(std::vector<Vertex>& vertices, const std::string& where) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Vertex& vertex = vertices[i];
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(vertex.position[c]))
        throw LoadError(fmt::format("{}: vertex {} is not at a finite place in its pose", where, i));
    for (int c = 0; c < 2; ++c) {
      vertex.texCoord0[c] = finiteOr(vertex.texCoord0[c], 0.0F);
      vertex.texCoord1[c] = finiteOr(vertex.texCoord1[c], 0.0F);
    }
    vertex.color = repairedColor(vertex.color);
  }
}

Primitive primitiveOf(int mode, const std::string& where) {
  switch (mode) {
    case TINYGLTF_MODE_TRIANGLES:
    case TINYGLTF_MODE_TRIANGLE_STRIP:
    case TINYGLTF_MODE_TRIANGLE_FAN:
      return Primitive::Triangles;
    case TINYGLTF_MODE_LINE:
    case TINYGLTF_MODE_LINE_LOOP:
    case TINYGLTF_MODE_LINE_STRIP:
      return Primitive::Lines;
    case TINYGLTF_MODE_POINTS:
      return Primitive::Points;
    default:
      throw LoadError(fmt::format("{}: mode is {}, which is none", where, mode));
  }
}

// Triangles that name a vertex twice may be among it.
std::vector<std::uint32_t> listOf(std::vector<std::uint32_t> indices, int mode) {
  switch (mode) {
    case TINYGLTF_MODE_TRIANGLES:
      indices.resize(indices.size() / 3 * 3);
      return indices;
    case TINYGLTF_MODE_TRIANGLE_STRIP:
      return triangleList(indices, Topology::Strip);
    case TINYGLTF_MODE_TRIANGLE_FAN:
      return triangleList(indices, Topology::Fan);
    case TINYGLTF_MODE_LINE:
      return lineList(indices, LineTopology::Lines);
    case TINYGLTF_MODE_LINE_LOOP:
      return lineList(indices, LineTopology::Loop);
    case TINYGLTF_MODE_LINE_STRIP:
      return lineList(indices, LineTopology::Strip);
    default:
      return indices; // points
  }
}

// The list of what a primitive with that many vertices consists of.
std::vector<std::uint32_t> readList(const GltfDocument& document, const tinygltf::Primitive& primitive,
                                    std::size_t vertexCount, const std::string& where) {
  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0) {
    indices = readIndices(document, static_cast<std::size_t>(primitive.indices));
    const auto wrong = std::ranges::find_if(indices, [=](std::uint32_t index) { return index >= vertexCount; });
    if (wrong != indices.end())
      throw LoadError(fmt::format("{}: index {} is {}, but there are {} vertices", where, wrong - indices.begin(),
                                  *wrong, vertexCount));
  } else {
    indices.resize(vertexCount);
    std::iota(indices.begin(), indices.end(), 0U);
  }
  return listOf(std::move(indices), primitive.mode);
}

// Keeps of the vertices what the mesh has. Tangents mean nothing without the normals that they were made for.
void keep(Mesh& mesh, const std::vector<Vertex>& vertices, const AccessorIndices& attributes) {
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
  if (mesh.primitive != Primitive::Triangles) {
    const auto usable = [](const glm::vec3& normal) {
      return glm::length(normal) > 0.0F && std::isfinite(glm::length(normal));
    };
    if (!std::ranges::all_of(normals, usable)) return;
    for (const glm::vec3& normal : normals) mesh.normals.push_back(packDirection(glm::normalize(normal)));
    return;
  }
  dropDegenerateTriangles(mesh);
  if (hasNormals) setRepairedNormals(mesh, std::move(normals));
  if (hasTangents) setRepairedTangents(mesh, tangents);
}

// Whether a skin or a morph target moves the vertices.
bool isPosed(const tinygltf::Primitive& primitive, const GltfPose& pose) {
  const std::size_t targets = std::min(primitive.targets.size(), pose.weights.size());
  return pose.skin != nullptr || std::ranges::any_of(pose.weights.first(targets), [](double w) { return w != 0.0; });
}

void finish(Mesh& mesh, const Material& material) {
  dropUnusedVertices(mesh);
  if (mesh.primitive != Primitive::Triangles) return;
  const bool mapped = material.normalTexture.image >= 0;
  if (!mesh.tangents.empty() || (!mapped && material.anisotropy <= 0.0F)) return;
  if (mesh.normals.empty()) makeFlatNormals(mesh);
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
  Mesh result;
  result.primitive = primitiveOf(source.mode, where);
  if (!source.attributes.contains("POSITION")) return result;

  if (isPosed(source, pose)) {
    std::vector<Vertex> vertices = posedVertices(source, material, pose, where);
    take(vertices.size());
    result.indices = readList(document_, source, vertices.size(), where);
    if (pose.skin != nullptr) applySkin(document_, *pose.skin, source, where, vertices, result.indices);
    repairAttributes(vertices, where);
    keep(result, vertices, source.attributes);
  } else {
    MeshArrays arrays(document_, source, where, result);
    arrays.readPlaces(material);
    take(result.vertexCount());
    result.indices = readList(document_, source, result.vertexCount(), where);
    if (result.primitive == Primitive::Triangles) dropDegenerateTriangles(result);
    arrays.readDirections();
  }
  take(result.indices.size());
  finish(result, material.material);
  return result;
}

std::vector<Vertex> GltfMeshReader::posedVertices(const tinygltf::Primitive& source, const GltfMaterial& material,
                                                  const GltfPose& pose, const std::string& where) const {
  VertexReader reader(document_, where);
  std::vector<Vertex> vertices = reader.read(source.attributes, material);
  for (std::size_t i = 0; i < std::min(source.targets.size(), pose.weights.size()); ++i)
    if (pose.weights[i] != 0.0)
      reader.morph(source.targets[i], material, static_cast<float>(pose.weights[i]), vertices);
  return vertices;
}

bool canFollowJoints(const tinygltf::Primitive& primitive) {
  return primitive.attributes.contains("JOINTS_0") && primitive.attributes.contains("WEIGHTS_0");
}

} // namespace vitrail::tool
