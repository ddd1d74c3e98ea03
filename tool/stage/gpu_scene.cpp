#include "gpu_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "light_data.h"
#include "material_data.h"
#include "placement.h"

namespace vitrail::tool {

namespace {

// Compute shaders of methods that rasterise themselves read all of it, too.
constexpr Access kInstanceFetch{VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
constexpr Access kIndexFetch{VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                             VK_ACCESS_2_INDEX_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
constexpr Access kShaderRead{VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                                 VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                             VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT};

constexpr VkBufferUsageFlags kStorageUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

// Counts the vertices or indices of a scene without wrapping round.
void checkCount(std::uint64_t count, std::uint64_t limit, const char* what) {
  if (count > limit) throw GpuError(fmt::format("the model has {} {}; at most {} can be drawn", count, what, limit));
}

// Uploads structures as one uniform buffer in which each starts at a multiple of its stride.
template <typename Data>
GpuBuffer uploadUniforms(Gpu& gpu, Uploader& uploader, const std::vector<Data>& data, const char* name) {
  constexpr std::uint32_t stride = kUniformStride<Data>;
  checkCount(data.size(), std::numeric_limits<std::uint32_t>::max() / stride, name);
  std::vector<std::byte> bytes(data.size() * stride);
  for (std::size_t i = 0; i < data.size(); ++i) std::memcpy(&bytes[i * stride], &data[i], sizeof(Data));
  // One at least, so that a scene without any has something to bind.
  GpuBuffer buffer(gpu, std::max<std::size_t>(bytes.size(), stride), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | kStorageUsage,
                   MemoryKind::Device, name);
  uploader.toBuffer(bytes, buffer, 0, kShaderRead);
  return buffer;
}

} // namespace

// The largest 32-bit index restarts strips, so a limit of 2^32 - 1 leaves that many vertices.
GpuScene::GpuScene(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order, Scene* released)
    : SceneDraws(scene, opacity, order, gpu.properties().limits.maxDrawIndexedIndexValue), gpu_(gpu) {
  Uploader uploader(gpu);
  uploadMaterials(uploader, scene, opacity);
  uploadLights(uploader, scene);
  textures_ = std::make_unique<MaterialTextures>(gpu, uploader, scene, *this);
  if (released != nullptr) {
    for (Image& image : released->images) image.rgba = std::vector<std::uint8_t>();
  }
  uploadInstances(uploader, scene);
  uploadMeshes(uploader, scene, released); // last: all else has been asked of them
}

void GpuScene::uploadMeshes(Uploader& uploader, const Scene& scene, Scene* released) {
  streams_.emplace(gpu_, scene, *this);
  indices_ =
      GpuBuffer(gpu_, indexBytes(), VK_BUFFER_USAGE_INDEX_BUFFER_BIT | kStorageUsage, MemoryKind::Device, "indices");
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    if (!usesMesh(i)) continue;
    streams_->upload(uploader, scene.meshes[i], i, released != nullptr ? &released->meshes[i] : nullptr);
    giveIndices(scene, i, [&](std::uint64_t offset, std::span<const std::byte> bytes) {
      uploader.toBuffer(bytes, indices_, offset, kIndexFetch);
    });
    if (released != nullptr) released->meshes[i].indices = std::vector<std::uint32_t>();
  }
}

void GpuScene::uploadMaterials(Uploader& uploader, const Scene& scene, std::optional<float> opacity) {
  std::vector<shaders::MaterialData> data;
  data.reserve(scene.materials.size());
  for (const Material& material : scene.materials) data.push_back(makeMaterialData(material, opacity));
  materials_ = uploadUniforms(gpu_, uploader, data, "materials");
}

void GpuScene::uploadLights(Uploader& uploader, const Scene& scene) {
  std::vector<shaders::LightData> data = makeLightData(scene, origin());
  lightCount_ = static_cast<std::uint32_t>(data.size());
  if (data.empty()) data.emplace_back(); // something to bind
  lights_ = GpuBuffer(gpu_, data.size() * sizeof(shaders::LightData), kStorageUsage, MemoryKind::Device, "lights");
  uploader.toBuffer(std::as_bytes(std::span(data)), lights_, 0,
                    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                     VK_ACCESS_2_SHADER_STORAGE_READ_BIT});
}

void GpuScene::uploadInstances(Uploader& uploader, const Scene& scene) {
  instances_ = GpuBuffer(gpu_, std::max<std::uint64_t>(instanceBytes(), kInstanceBytes),
                         VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | kStorageUsage, MemoryKind::Device, "instances");
  giveInstances(scene, [&](std::uint64_t offset, std::span<const std::byte> bytes) {
    uploader.toBuffer(bytes, instances_, offset, kInstanceFetch);
  });
}

void GpuScene::cmdBindInstances(VkCommandBuffer commands) const {
  const VkBuffer buffer = instances_.get();
  const VkDeviceSize offset = 0;
  const VkDeviceSize stride = kInstanceBytes;
  vkCmdBindVertexBuffers2(commands, kInstanceBinding, 1, &buffer, &offset, nullptr, &stride);
}

} // namespace vitrail::tool
