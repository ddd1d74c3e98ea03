#include "vertex_streams.h"

#include <cstdint>

namespace vitrail::tool {

namespace {

// By vertex shaders, and by compute shaders of methods that rasterise themselves.
constexpr Access kVertexFetch{VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
constexpr VkBufferUsageFlags kVertexUsage =
    VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

} // namespace

VertexLayout surfaceVertexLayout() {
  static constexpr std::array<VkVertexInputBindingDescription, kStreamCount + 1> kBindings{{
      {0, kStreamBytes[0], VK_VERTEX_INPUT_RATE_VERTEX},
      {1, kStreamBytes[1], VK_VERTEX_INPUT_RATE_VERTEX},
      {2, kStreamBytes[2], VK_VERTEX_INPUT_RATE_VERTEX},
      {3, kStreamBytes[3], VK_VERTEX_INPUT_RATE_VERTEX},
      {4, kStreamBytes[4], VK_VERTEX_INPUT_RATE_VERTEX},
      {5, kStreamBytes[5], VK_VERTEX_INPUT_RATE_VERTEX},
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

VertexStreams::VertexStreams(Gpu& gpu, const Scene& scene, const SceneDraws& draws)
    : places_(placeVertices(scene, draws)) {
  Uploader uploader(gpu);
  const Mesh values = defaultVertex();
  const auto arrays = vertexArrays(values);
  for (std::size_t stream = 0; stream < kStreamCount; ++stream) {
    buffers_[stream] = GpuBuffer(gpu, places_.bytes[stream], kVertexUsage, MemoryKind::Device, kStreamNames[stream]);
    uploader.toBuffer(arrays[stream], buffers_[stream], 0, kVertexFetch);
  }
}

void VertexStreams::upload(Uploader& uploader, const Mesh& mesh, std::size_t index, Mesh* released) {
  const auto arrays = vertexArrays(mesh);
  for (std::size_t stream = 0; stream < kStreamCount; ++stream) {
    uploader.toBuffer(arrays[stream], buffers_[stream], places_.meshes[index].offsets[stream], kVertexFetch);
    if (released != nullptr) releaseArray(*released, stream);
  }
}

void VertexStreams::cmdBind(VkCommandBuffer commands, std::size_t mesh) const {
  std::array<VkBuffer, kStreamCount> buffers{};
  for (std::size_t stream = 0; stream < kStreamCount; ++stream) buffers[stream] = buffers_[stream].get();
  const VertexPlace& place = places_.meshes[mesh];
  vkCmdBindVertexBuffers2(commands, 0, kStreamCount, buffers.data(), place.offsets.data(), nullptr,
                          place.strides.data());
}

} // namespace vitrail::tool
