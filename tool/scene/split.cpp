#include "split.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace vitrail::tool {

namespace {

// The mean of two directions of unit length; the first where they cancel out.
glm::vec3 between(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 sum = a + b;
  return glm::dot(sum, sum) > 1e-6F ? glm::normalize(sum) : a;
}

Vertex middleOf(const Vertex& a, const Vertex& b) {
  Vertex middle;
  middle.position = 0.5F * (a.position + b.position);
  middle.normal = between(a.normal, b.normal);
  middle.tangent = glm::vec4(between(glm::vec3(a.tangent), glm::vec3(b.tangent)), a.tangent.w);
  middle.texCoord0 = 0.5F * (a.texCoord0 + b.texCoord0);
  middle.texCoord1 = 0.5F * (a.texCoord1 + b.texCoord1);
  middle.color = 0.5F * (a.color + b.color);
  return middle;
}

void split(Mesh& mesh) {
  std::unordered_map<std::uint64_t, std::uint32_t> middles; // by the two ends of an edge
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint64_t edge = std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
    const auto [place, isNew] = middles.try_emplace(edge, static_cast<std::uint32_t>(mesh.vertexCount()));
    if (isNew) mesh.add(middleOf(mesh.vertex(a), mesh.vertex(b)));
    return place->second;
  };
  std::vector<std::uint32_t> indices;
  indices.reserve(4 * mesh.indices.size());
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i];
    const std::uint32_t b = mesh.indices[i + 1];
    const std::uint32_t c = mesh.indices[i + 2];
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    indices.insert(indices.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
  }
  mesh.indices = std::move(indices);
}

} // namespace

Scene splitTriangles(Scene scene, std::uint32_t times) {
  for (std::uint32_t i = 0; i < times; ++i)
    for (Mesh& mesh : scene.meshes)
      if (mesh.primitive == Primitive::Triangles) split(mesh);
  return scene;
}

} // namespace vitrail::tool
