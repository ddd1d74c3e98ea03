#include "gpu_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <set>
#include <span>
#include <tuple>

#include <fmt/format.h>

#include "material_data.h"

namespace vitrail::tool {

namespace {

constexpr Access kVertexFetch{VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT};
constexpr Access kIndexFetch{VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT};
constexpr Access kShaderRead{VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                             VK_ACCESS_2_UNIFORM_READ_BIT};

// The middle of a scene that is far away compared with its size, else 0: most scenes keep their own numbers.
glm::dvec3 farMiddle(const Scene& scene) {
  if (scene.draws.empty()) return glm::dvec3(0.0);
  const Bounds bounds = worldBounds(scene);
  const glm::dvec3 low(bounds.min);
  const glm::dvec3 high(bounds.max);
  const glm::dvec3 middle = 0.5 * (low + high);
  return glm::length(middle) > 8.0 * glm::length(high - low) ? middle : glm::dvec3(0.0);
}

// Counts the vertices or indices of a scene without wrapping round.
void checkCount(std::uint64_t count, std::uint64_t limit, const char* what) {
  if (count > limit) throw GpuError(fmt::format("the model has {} {}; at most {} can be drawn", count, what, limit));
}

double determinant(const glm::mat4& transform) { return glm::determinant(glm::dmat3(glm::dmat4(transform))); }

// Turns normals as the transform turns planes: its cofactors, which exist even where it has no inverse, scaled so that
// their squares stay in the range of a float. A mirror's cofactors point inwards, hence the sign.
glm::dmat3 normalMatrix(const glm::mat4& transform, double sign) {
  const glm::dmat3 m{glm::dmat4(transform)};
  glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  double largest = 0.0;
  for (int i = 0; i < 9; ++i) largest = std::max(largest, std::abs(cofactors[i / 3][i % 3]));
  return largest > 0.0 ? cofactors * (sign / largest) : cofactors;
}

shaders::DrawData makeDrawData(const Draw& draw, const glm::dvec3& origin) {
  const double sign = determinant(draw.transform) < 0.0 ? -1.0 : 1.0;
  const glm::dmat3 normals = normalMatrix(draw.transform, sign);
  shaders::DrawData data{};
  data.model = draw.transform;
  data.model[3] = glm::vec4(glm::dvec3(draw.transform[3]) - origin, draw.transform[3].w);
  data.normal0 = glm::vec4(normals[0], sign);
  data.normal1 = glm::vec4(normals[1], 0.0);
  data.normal2 = glm::vec4(normals[2], 0.0);
  return data;
}

bool hasVertexColors(const Mesh& mesh) {
  return std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const Vertex& vertex) { return vertex.color != glm::vec4(1.0F); });
}

// The box around a mesh's triangles.
Bounds boundsOf(const Mesh& mesh) {
  const glm::vec3& first = mesh.vertices[mesh.indices.front()].position;
  Bounds bounds{first, first};
  for (const std::uint32_t index : mesh.indices) {
    bounds.min = glm::min(bounds.min, mesh.vertices[index].position);
    bounds.max = glm::max(bounds.max, mesh.vertices[index].position);
  }
  return bounds;
}

std::vector<std::uint32_t> usedMaterials(const Scene& scene) {
  std::set<std::uint32_t> used;
  for (const Draw& draw : scene.draws) used.insert(draw.material);
  return {used.begin(), used.end()};
}

// Uploads structures as one uniform buffer in which each starts at a multiple of kUniformStride.
template <typename Data>
GpuBuffer uploadUniforms(Gpu& gpu, Uploader& uploader, const std::vector<Data>& data, const char* name) {
  static_assert(sizeof(Data) <= kUniformStride);
  checkCount(data.size(), std::numeric_limits<std::uint32_t>::max() / kUniformStride, name);
  std::vector<std::byte> bytes(data.size() * kUniformStride);
  for (std::size_t i = 0; i < data.size(); ++i) std::memcpy(&bytes[i * kUniformStride], &data[i], sizeof(Data));
  // One at least, so that a scene without any has something to bind.
  GpuBuffer buffer(gpu, std::max<std::size_t>(bytes.size(), kUniformStride),
                   VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Device, name);
  uploader.toBuffer(bytes, buffer, 0, kShaderRead);
  return buffer;
}

} // namespace

GpuScene::GpuScene(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order)
    : gpu_(gpu), order_(order), origin_(farMiddle(scene)) {
  Uploader uploader(gpu);
  const std::vector<MeshRange> ranges = placeMeshes(scene, opacity.has_value(), order);
  uploadMeshes(uploader, scene, ranges);
  uploadMaterials(uploader, scene, opacity);
  uploadDraws(uploader, scene);
  textures_ = std::make_unique<MaterialTextures>(gpu, uploader, scene, usedMaterials(scene));
  listDraws(scene, ranges, opacity.has_value(), order);
  placeBoxes(scene);
}

// A mesh that is drawn both opaque and transparent has its indices twice where their orders differ.
std::vector<GpuScene::MeshRange> GpuScene::placeMeshes(const Scene& scene, bool allTransparent, DrawOrder order) {
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
    checkCount(mesh.vertices.size(), gpu_.properties().limits.maxDrawIndexedIndexValue, "vertices in one mesh");
    range.vertexColors = hasVertexColors(mesh);
    range.firstVertex = vertexCount_;
    vertexCount_ += mesh.vertices.size();
    range.firstOpaqueIndex = indexCount_;
    if (range.opaque) indexCount_ += mesh.indices.size();
    const bool shared = range.opaque && order == DrawOrder::Forward;
    range.firstTransparentIndex = shared ? range.firstOpaqueIndex : indexCount_;
    if (range.transparent && !shared) indexCount_ += mesh.indices.size();
  }
  checkCount(vertexCount_, std::numeric_limits<std::int32_t>::max(), "vertices");
  checkCount(indexCount_, std::numeric_limits<std::uint32_t>::max(), "indices");
  return ranges;
}

// A mesh's indices as transparent draws submit them.
std::vector<std::uint32_t> GpuScene::submittedIndices(const Scene& scene, std::size_t mesh) const {
  return reorderTriangles(scene.meshes[mesh].indices, order_, mesh + 1);
}

std::vector<std::uint32_t> GpuScene::transparentIndices(const Scene& scene, std::size_t i) const {
  return submittedIndices(scene, scene.draws[transparent_[i].source].mesh);
}

void GpuScene::uploadMeshes(Uploader& uploader, const Scene& scene, const std::vector<MeshRange>& ranges) {
  vertices_ =
      GpuBuffer(gpu_, vertexCount_ * sizeof(Vertex),
                VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Device, "vertices");
  indices_ =
      GpuBuffer(gpu_, indexCount_ * sizeof(std::uint32_t),
                VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Device, "indices");
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const MeshRange& range = ranges[i];
    if (!range.opaque && !range.transparent) continue;
    const Mesh& mesh = scene.meshes[i];
    uploader.toBuffer(std::as_bytes(std::span(mesh.vertices)), vertices_, range.firstVertex * sizeof(Vertex),
                      kVertexFetch);
    if (range.opaque || order_ == DrawOrder::Forward) {
      const std::uint64_t first = range.opaque ? range.firstOpaqueIndex : range.firstTransparentIndex;
      uploader.toBuffer(std::as_bytes(std::span(mesh.indices)), indices_, first * sizeof(std::uint32_t), kIndexFetch);
    }
    if (range.transparent && order_ != DrawOrder::Forward) {
      const std::vector<std::uint32_t> reordered = submittedIndices(scene, i);
      uploader.toBuffer(std::as_bytes(std::span(reordered)), indices_,
                        range.firstTransparentIndex * sizeof(std::uint32_t), kIndexFetch);
    }
  }
}

void GpuScene::uploadMaterials(Uploader& uploader, const Scene& scene, std::optional<float> opacity) {
  std::vector<shaders::MaterialData> data;
  data.reserve(scene.materials.size());
  for (const Material& material : scene.materials) data.push_back(makeMaterialData(material, opacity));
  materials_ = uploadUniforms(gpu_, uploader, data, "materials");
}

void GpuScene::uploadDraws(Uploader& uploader, const Scene& scene) {
  std::vector<shaders::DrawData> data;
  data.reserve(scene.draws.size());
  for (const Draw& draw : scene.draws) data.push_back(makeDrawData(draw, origin_));
  drawData_ = uploadUniforms(gpu_, uploader, data, "draws");
}

void GpuScene::listDraws(const Scene& scene, const std::vector<MeshRange>& ranges, bool allTransparent,
                         DrawOrder order) {
  for (std::uint32_t i = 0; i < scene.draws.size(); ++i) {
    const Draw& source = scene.draws[i];
    const Material& material = scene.materials[source.material];
    const MeshRange& range = ranges[source.mesh];
    const bool transparent = allTransparent || isTransparent(material);
    GpuDraw draw;
    draw.source = i;
    draw.dataOffset = i * kUniformStride;
    draw.materialOffset = source.material * kUniformStride;
    draw.firstIndex = static_cast<std::uint32_t>(transparent ? range.firstTransparentIndex : range.firstOpaqueIndex);
    draw.indexCount = static_cast<std::uint32_t>(scene.meshes[source.mesh].indices.size());
    draw.vertexOffset = static_cast<std::int32_t>(range.firstVertex);
    draw.features = featuresOf(scene, material, range.vertexColors);
    draw.textures = textures_->set(source.material);
    // A mirror turns the triangles round, and glTF means the side that was outside before.
    draw.frontFace = determinant(source.transform) < 0.0 ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE;
    draw.cullMode = transparent || material.doubleSided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
    if (draw.indexCount > 0) (transparent ? transparent_ : opaque_).push_back(draw);
  }
  // Depth decides between opaque surfaces: draws that bind the same things go together.
  std::stable_sort(opaque_.begin(), opaque_.end(), [](const GpuDraw& a, const GpuDraw& b) {
    return std::tie(a.features, a.materialOffset) < std::tie(b.features, b.materialOffset);
  });
  std::vector<GpuDraw> ordered;
  ordered.reserve(transparent_.size());
  for (const std::uint32_t i : submissionOrder(static_cast<std::uint32_t>(transparent_.size()), order, 0)) {
    ordered.push_back(transparent_[i]);
  }
  transparent_ = std::move(ordered);
}

void GpuScene::placeBoxes(const Scene& scene) {
  std::vector<std::optional<Bounds>> known(scene.meshes.size());
  for (const GpuDraw& drawn : transparent_) {
    const Draw& draw = scene.draws[drawn.source];
    std::optional<Bounds>& box = known[draw.mesh];
    if (!box) box = boundsOf(scene.meshes[draw.mesh]);
    boxes_.push_back({*box, makeDrawData(draw, origin_).model});
  }
}

} // namespace vitrail::tool
