#include "vertex_streams.h"

#include <cstring>
#include <span>

namespace vitrail::tool {

namespace {

constexpr Access kVertexFetch{VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT};
constexpr std::uint64_t kDefaultBytes = 16; // each buffer begins with the value of meshes without the attribute

constexpr std::array<const char*, kStreamCount> kNames{
    "positions", "normals", "tangents", "texture coordinates 0", "texture coordinates 1", "vertex colours"};
constexpr std::array<std::uint32_t, kStreamCount> kBytes{sizeof(glm::vec3),     sizeof(std::uint32_t),
                                                         sizeof(std::uint32_t), sizeof(glm::vec2),
                                                         sizeof(glm::vec2),     sizeof(std::uint64_t)};

std::array<std::span<const std::byte>, kStreamCount> arraysOf(const Mesh& mesh) {
  return {std::as_bytes(std::span(mesh.positions)),  std::as_bytes(std::span(mesh.normals)),
          std::as_bytes(std::span(mesh.tangents)),   std::as_bytes(std::span(mesh.texCoords0)),
          std::as_bytes(std::span(mesh.texCoords1)), std::as_bytes(std::span(mesh.colors))};
}

template <typename Value>
void release(std::vector<Value>& values) {
  values = std::vector<Value>(); // clear() would keep the memory
}

void releaseArray(Mesh& mesh, std::size_t stream) {
  if (stream == 0) release(mesh.positions);
  if (stream == 1) release(mesh.normals);
  if (stream == 2) release(mesh.tangents);
  if (stream == 3) release(mesh.texCoords0);
  if (stream == 4) release(mesh.texCoords1);
  if (stream == 5) release(mesh.colors);
}

// A mesh of one vertex that has everything, with the values of a vertex that has nothing.
Mesh defaults() {
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

} // namespace

VertexLayout surfaceVertexLayout() {
  static constexpr std::array<VkVertexInputBindingDescription, kStreamCount + 1> kBindings{{
      {0, kBytes[0], VK_VERTEX_INPUT_RATE_VERTEX},
      {1, kBytes[1], VK_VERTEX_INPUT_RATE_VERTEX},
      {2, kBytes[2], VK_VERTEX_INPUT_RATE_VERTEX},
      {3, kBytes[3], VK_VERTEX_INPUT_RATE_VERTEX},
      {4, kBytes[4], VK_VERTEX_INPUT_RATE_VERTEX},
      {5, kBytes[5], VK_VERTEX_INPUT_RATE_VERTEX},
      {kInstanceBinding, kInstanceBytes, VK_VERTEX_INPUT_RATE_INSTANCE},
  }};
  static constexpr std::array<VkVertexInputAttributeDescription, 9> kAttributes{{
      {0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
      {1, 1, VK_FORMAT_R16G16_SNORM, 0},
      {2, 2, VK_FORMAT_R16G16_SINT, 0},
      {3, 3, VK_FORMAT_R32G32_SFLOAT, 0},
      {4, 4, VK_FORMAT_R32G32_SFLOAT, 0},
      {5, 5, VK_FORMAT_R16G16B16A16_SFLOAT, 0},
      {6, kInstanceBinding, VK_FORMAT_R32G32B32A32_SFLOAT, 0},
      {7, kInstanceBinding, VK_FORMAT_R32G32B32A32_SFLOAT, 16},
      {8, kInstanceBinding, VK_FORMAT_R32G32B32A32_SFLOAT, 32},
  }};
  return {kBindings, kAttributes};
}

VertexStreams::VertexStreams(Gpu& gpu, const Scene& scene, const std::vector<bool>& used)
    : places_(scene.meshes.size()) {
  std::array<std::uint64_t, kStreamCount> sizes;
  sizes.fill(kDefaultBytes);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (!used[i]) continue;
    const auto arrays = arraysOf(scene.meshes[i]);
    for (std::size_t stream = 0; stream < kStreamCount; ++stream) {
      if (arrays[stream].empty()) continue;
      places_[i].offsets[stream] = sizes[stream];
      places_[i].strides[stream] = kBytes[stream];
      sizes[stream] += arrays[stream].size();
    }
  }
  Uploader uploader(gpu);
  const Mesh values = defaults();
  const auto arrays = arraysOf(values);
  for (std::size_t stream = 0; stream < kStreamCount; ++stream) {
    buffers_[stream] =
        GpuBuffer(gpu, sizes[stream], VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                  MemoryKind::Device, kNames[stream]);
    uploader.toBuffer(arrays[stream], buffers_[stream], 0, kVertexFetch);
  }
}

void VertexStreams::upload(Uploader& uploader, const Mesh& mesh, std::size_t index, Mesh* released) {
  const auto arrays = arraysOf(mesh);
  for (std::size_t stream = 0; stream < kStreamCount; ++stream) {
    uploader.toBuffer(arrays[stream], buffers_[stream], places_[index].offsets[stream], kVertexFetch);
    if (released != nullptr) releaseArray(*released, stream);
  }
}

void VertexStreams::cmdBind(VkCommandBuffer commands, std::size_t mesh) const {
  std::array<VkBuffer, kStreamCount> buffers{};
  for (std::size_t stream = 0; stream < kStreamCount; ++stream) buffers[stream] = buffers_[stream].get();
  const Place& place = places_[mesh];
  vkCmdBindVertexBuffers2(commands, 0, kStreamCount, buffers.data(), place.offsets.data(), nullptr,
                          place.strides.data());
}

} // namespace vitrail::tool
