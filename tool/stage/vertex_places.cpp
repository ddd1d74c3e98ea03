#include "vertex_places.h"

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kDefaultBytes = 16; // of the value of meshes without the attribute

template <typename Value>
void release(std::vector<Value>& values) {
  values = std::vector<Value>(); // clear() would keep the memory
}

} // namespace

const std::array<const char*, kStreamCount> kStreamNames{
    "positions", "normals", "tangents", "texture coordinates 0", "texture coordinates 1", "vertex colours"};

std::array<std::span<const std::byte>, kStreamCount> vertexArrays(const Mesh& mesh) {
  return {std::as_bytes(std::span(mesh.positions)),  std::as_bytes(std::span(mesh.normals)),
          std::as_bytes(std::span(mesh.tangents)),   std::as_bytes(std::span(mesh.texCoords0)),
          std::as_bytes(std::span(mesh.texCoords1)), std::as_bytes(std::span(mesh.colors))};
}

void releaseArray(Mesh& mesh, std::size_t stream) {
  if (stream == 0) release(mesh.positions);
  if (stream == 1) release(mesh.normals);
  if (stream == 2) release(mesh.tangents);
  if (stream == 3) release(mesh.texCoords0);
  if (stream == 4) release(mesh.texCoords1);
  if (stream == 5) release(mesh.colors);
}

Mesh defaultVertex() {
  const Vertex vertex;
  Mesh mesh;
  mesh.positions = {vertex.position};
  mesh.normals = {packDirection(vertex.normal)};
  mesh.tangents = {packTangent(vertex.tangent)};
  mesh.texCoords0 = {vertex.texCoord0};
  mesh.texCoords1 = {vertex.texCoord1};
  mesh.colors = {packColor(vertex.color)};
  return mesh;
}

VertexPlaces placeVertices(const Scene& scene, const SceneDraws& draws) {
  VertexPlaces places;
  places.meshes.resize(scene.meshes.size());
  places.bytes.fill(kDefaultBytes);
  for (std::size_t i = 0; i < places.meshes.size(); ++i) {
    if (!draws.usesMesh(i)) continue;
    const auto arrays = vertexArrays(scene.meshes[i]);
    places.meshes[i].vertices = static_cast<std::uint32_t>(scene.meshes[i].positions.size());
    for (std::size_t stream = 0; stream < kStreamCount; ++stream) {
      if (arrays[stream].empty()) continue;
      places.meshes[i].offsets[stream] = places.bytes[stream];
      places.meshes[i].strides[stream] = kStreamBytes[stream];
      places.bytes[stream] += arrays[stream].size();
    }
  }
  return places;
}

} // namespace vitrail::tool
