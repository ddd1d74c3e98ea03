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

constexpr Access kInstanceFetch{VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT};
constexpr Access kIndexFetch{VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT};
constexpr Access kShaderRead{VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                             VK_ACCESS_2_UNIFORM_READ_BIT};

// Counts the vertices or indices of a scene without wrapping round.
void checkCount(std::uint64_t count, std::uint64_t limit, const char* what) {
  if (count > limit) throw GpuError(fmt::format("the model has {} {}; at most {} can be drawn", count, what, limit));
}

// An instance's transform to the GPU's space as surface.vert takes it.
std::array<glm::vec4, 3> rowsOf(const glm::mat4& place) {
  const glm::mat4 rows = glm::transpose(place);
  return {rows[0], rows[1], rows[2]};
}

std::vector<std::uint32_t> usedMaterials(const Scene& scene) {
  std::set<std::uint32_t> used;
  for (const Draw& draw : scene.draws) used.insert(draw.material);
  return {used.begin(), used.end()};
}

// Uploads structures as one uniform buffer in which each starts at a multiple of its stride.
template <typename Data>
GpuBuffer uploadUniforms(Gpu& gpu, Uploader& uploader, const std::vector<Data>& data, const char* name) {
  constexpr std::uint32_t stride = kUniformStride<Data>;
  checkCount(data.size(), std::numeric_limits<std::uint32_t>::max() / stride, name);
  std::vector<std::byte> bytes(data.size() * stride);
  for (std::size_t i = 0; i < data.size(); ++i) std::memcpy(&bytes[i * stride], &data[i], sizeof(Data));
  // One at least, so that a scene without any has something to bind.
  GpuBuffer buffer(gpu, std::max<std::size_t>(bytes.size(), stride),
                   VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Device, name);
  uploader.toBuffer(bytes, buffer, 0, kShaderRead);
  return buffer;
}

} // namespace

GpuScene::GpuScene(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order, Scene* released)
    : gpu_(gpu), order_(order), solids_(scene), opacity_(opacity.value_or(1.0F)), origin_(drawnOrigin(scene)) {
  Uploader uploader(gpu);
  const std::vector<MeshRange> ranges = placeMeshes(scene, opacity.has_value());
  uploadMaterials(uploader, scene, opacity);
  uploadLights(uploader, scene);
  textures_ = std::make_unique<MaterialTextures>(gpu, uploader, scene, usedMaterials(scene));
  if (released != nullptr)
    for (Image& image : released->images) image.rgba = std::vector<std::uint8_t>();
  listDraws(scene, ranges, opacity.has_value());
  uploadInstances(uploader, scene);
  placeBoxes(scene);
  uploadMeshes(uploader, scene, ranges, released); // last: all else has been asked of them
}

// A mesh that is drawn both opaque and transparent has its indices twice where their orders differ.
std::vector<GpuScene::MeshRange> GpuScene::placeMeshes(const Scene& scene, bool allTransparent) {
  std::vector<MeshRange> ranges(scene.meshes.size());
  for (const Draw& draw : scene.draws) {
    const bool transparent = allTransparent || isTransparent(scene.materials.at(draw.material));
    MeshRange& range = ranges.at(draw.mesh);
    (transparent ? range.transparent : range.opaque) = true;
  }
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    MeshRange& range = ranges[i];
    if (!range.opaque && !range.transparent) continue;
    const Mesh& mesh = scene.meshes[i];
    // The largest 32-bit index restarts strips, so a limit of 2^32 - 1 leaves that many vertices.
    checkCount(mesh.vertexCount(), gpu_.properties().limits.maxDrawIndexedIndexValue, "vertices in one mesh");
    range.firstOpaqueIndex = indexCount_;
    if (range.opaque) indexCount_ += mesh.indices.size();
    const bool shared = range.opaque && order_ == DrawOrder::Forward;
    range.firstTransparentIndex = shared ? range.firstOpaqueIndex : indexCount_;
    if (range.transparent && !shared) indexCount_ += mesh.indices.size();
  }
  checkCount(indexCount_, std::numeric_limits<std::uint32_t>::max(), "indices");
  checkCount(scene.draws.size(), std::numeric_limits<std::uint32_t>::max(), "objects");
  return ranges;
}

// A mesh's indices as transparent draws submit them.
std::vector<std::uint32_t> GpuScene::submittedIndices(const Scene& scene, std::size_t mesh) const {
  return reorderPrimitives(scene.meshes[mesh], order_, mesh + 1);
}

std::vector<std::uint32_t> GpuScene::transparentIndices(const Scene& scene, std::size_t i) const {
  return submittedIndices(scene, transparent_[i].mesh);
}

void GpuScene::uploadMeshes(Uploader& uploader, const Scene& scene, const std::vector<MeshRange>& ranges,
                            Scene* released) {
  std::vector<bool> used;
  for (const MeshRange& range : ranges) used.push_back(range.opaque || range.transparent);
  streams_.emplace(gpu_, scene, used);
  indices_ =
      GpuBuffer(gpu_, indexCount_ * sizeof(std::uint32_t),
                VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Device, "indices");
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const MeshRange& range = ranges[i];
    if (!used[i]) continue;
    const Mesh& mesh = scene.meshes[i];
    streams_->upload(uploader, mesh, i, released != nullptr ? &released->meshes[i] : nullptr);
    if (range.opaque || order_ == DrawOrder::Forward) {
      const std::uint64_t first = range.opaque ? range.firstOpaqueIndex : range.firstTransparentIndex;
      uploader.toBuffer(std::as_bytes(std::span(mesh.indices)), indices_, first * sizeof(std::uint32_t), kIndexFetch);
    }
    if (range.transparent && order_ != DrawOrder::Forward) {
      const std::vector<std::uint32_t> reordered = submittedIndices(scene, i);
      uploader.toBuffer(std::as_bytes(std::span(reordered)), indices_,
                        range.firstTransparentIndex * sizeof(std::uint32_t), kIndexFetch);
    }
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
  std::vector<shaders::LightData> data = makeLightData(scene, origin_);
  lightCount_ = static_cast<std::uint32_t>(data.size());
  if (data.empty()) data.emplace_back(); // something to bind
  lights_ =
      GpuBuffer(gpu_, data.size() * sizeof(shaders::LightData),
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Device, "lights");
  uploader.toBuffer(std::as_bytes(std::span(data)), lights_, 0,
                    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT});
}

glm::mat4 GpuScene::placeOf(const Scene& scene, std::uint32_t instance) const {
  return placed(scene.draws[sources_[instance]].transform, origin_);
}

// In pieces: there may be millions.
void GpuScene::uploadInstances(Uploader& uploader, const Scene& scene) {
  constexpr std::size_t kPiece = 100'000;
  const std::size_t count = sources_.size();
  instances_ =
      GpuBuffer(gpu_, std::max<std::uint64_t>(count, 1) * kInstanceBytes,
                VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Device, "instances");
  std::vector<std::array<glm::vec4, 3>> rows;
  static_assert(sizeof(rows[0]) == kInstanceBytes);
  for (std::size_t first = 0; first < count; first += kPiece) {
    rows.clear();
    for (std::size_t i = first; i < std::min(first + kPiece, count); ++i) {
      rows.push_back(rowsOf(placeOf(scene, static_cast<std::uint32_t>(i))));
    }
    uploader.toBuffer(std::as_bytes(std::span(rows)), instances_, first * kInstanceBytes, kInstanceFetch);
  }
}

void GpuScene::cmdBindInstances(VkCommandBuffer commands) const {
  const VkBuffer buffer = instances_.get();
  const VkDeviceSize offset = 0;
  const VkDeviceSize stride = kInstanceBytes;
  vkCmdBindVertexBuffers2(commands, kInstanceBinding, 1, &buffer, &offset, nullptr, &stride);
}

// The draw of a group whose instances come next.
GpuDraw GpuScene::describe(const Scene& scene, const DrawGroup& group, const MeshRange& range, bool transparent) const {
  const Material& material = scene.materials[group.material];
  const Mesh& mesh = scene.meshes[group.mesh];
  GpuDraw draw;
  draw.mesh = group.mesh;
  draw.materialOffset = group.material * kUniformStride<shaders::MaterialData>;
  draw.firstIndex = static_cast<std::uint32_t>(transparent ? range.firstTransparentIndex : range.firstOpaqueIndex);
  draw.indexCount = static_cast<std::uint32_t>(mesh.indices.size());
  draw.firstInstance = static_cast<std::uint32_t>(sources_.size());
  draw.instanceCount = static_cast<std::uint32_t>(group.draws.size());
  draw.features = featuresOf(scene, material, mesh, textures_->isPremultiplied(group.material));
  if (solids_.of(group.mesh, group.material) != Facing::Open) draw.features |= shaders::FEATURE_SOLID;
  draw.textures = textures_->set(group.material);
  // A mirror turns the triangles round, and glTF means the side that was outside before.
  draw.frontFace = group.mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE;
  draw.cullMode = transparent || material.doubleSided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
  return draw;
}

void GpuScene::listDraws(const Scene& scene, const std::vector<MeshRange>& ranges, bool allTransparent) {
  sources_.reserve(scene.draws.size());
  for (const bool transparent : {false, true}) {
    std::vector<DrawGroup> groups = groupDraws(scene, transparent, allTransparent);
    if (transparent) reorderGroups(groups, order_);
    for (const DrawGroup& group : groups) {
      (transparent ? transparent_ : opaque_).push_back(describe(scene, group, ranges[group.mesh], transparent));
      sources_.insert(sources_.end(), group.draws.begin(), group.draws.end());
    }
  }
  orderOpaque(opaque_, [](const GpuDraw& draw) { return std::pair(draw.features, draw.materialOffset); });
}

void GpuScene::placeBoxes(const Scene& scene) {
  constexpr std::uint64_t kMostBoxes = 65536;
  std::uint64_t instances = 0;
  for (const GpuDraw& draw : transparent_) instances += draw.instanceCount;
  for (const GpuDraw& draw : transparent_) {
    const Bounds box = boundsOf(scene.meshes[draw.mesh]);
    Bounds around{glm::vec3(std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::lowest())};
    for (std::uint32_t i = draw.firstInstance; i < draw.firstInstance + draw.instanceCount; ++i) {
      const glm::mat4 place = placeOf(scene, i);
      if (instances <= kMostBoxes) {
        boxes_.push_back({box, place});
        continue;
      }
      for (const glm::vec3& corner : cornersOf(box)) {
        const glm::vec3 placed(place * glm::vec4(corner, 1.0F));
        around.min = glm::min(around.min, placed);
        around.max = glm::max(around.max, placed);
      }
    }
    if (instances > kMostBoxes) boxes_.push_back({around, glm::mat4(1.0F)});
  }
}

} // namespace vitrail::tool
