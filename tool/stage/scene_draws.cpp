#include "scene_draws.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "../gpu/gpu_error.h"
#include "material_data.h"
#include "placement.h"
#include "surface_shared.h"
#include "texels.h"

namespace vitrail::tool {

namespace {

// Counts the vertices or indices of a scene without wrapping round.
void checkCount(std::uint64_t count, std::uint64_t limit, const char* what) {
  if (count > limit) throw GpuError(fmt::format("the model has {} {}; at most {} can be drawn", count, what, limit));
}

// An instance's transform to the GPU's space as surface.vert takes it.
std::array<glm::vec4, 3> rowsOf(const glm::mat4& place) {
  const glm::mat4 rows = glm::transpose(place);
  return {rows[0], rows[1], rows[2]};
}

} // namespace

SceneDraws::SceneDraws(const Scene& scene, std::optional<float> opacity, DrawOrder order, std::uint32_t mostVertices)
    : order_(order),
      solids_(scene),
      opacity_(opacity.value_or(1.0F)),
      origin_(drawnOrigin(scene)),
      materials_(usedMaterials(scene)),
      premultiplied_(premultipliedMaterials(scene, materials_)) {
  placeMeshes(scene, opacity.has_value(), mostVertices);
  listDraws(scene, opacity.has_value());
  placeBoxes(scene);
}

// A mesh that is drawn both opaque and transparent has its indices twice where their orders differ.
void SceneDraws::placeMeshes(const Scene& scene, bool allTransparent, std::uint32_t mostVertices) {
  ranges_.resize(scene.meshes.size());
  for (const Draw& draw : scene.draws) {
    const bool transparent = allTransparent || isTransparent(scene.materials.at(draw.material));
    MeshRange& range = ranges_.at(draw.mesh);
    (transparent ? range.transparent : range.opaque) = true;
  }
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    MeshRange& range = ranges_[i];
    if (!range.opaque && !range.transparent) continue;
    const Mesh& mesh = scene.meshes[i];
    checkCount(mesh.vertexCount(), mostVertices, "vertices in one mesh");
    range.firstOpaqueIndex = indexCount_;
    if (range.opaque) indexCount_ += mesh.indices.size();
    const bool shared = range.opaque && order_ == DrawOrder::Forward;
    range.firstTransparentIndex = shared ? range.firstOpaqueIndex : indexCount_;
    if (range.transparent && !shared) indexCount_ += mesh.indices.size();
  }
  checkCount(indexCount_, std::numeric_limits<std::uint32_t>::max(), "indices");
  checkCount(scene.draws.size(), std::numeric_limits<std::uint32_t>::max(), "objects");
}

// A mesh's indices as transparent draws submit them.
std::vector<std::uint32_t> SceneDraws::submittedIndices(const Scene& scene, std::size_t mesh) const {
  return reorderPrimitives(scene.meshes[mesh], order_, mesh + 1);
}

std::vector<std::uint32_t> SceneDraws::transparentIndices(const Scene& scene, std::size_t i) const {
  return submittedIndices(scene, transparent_[i].mesh);
}

void SceneDraws::giveIndices(const Scene& scene, std::size_t mesh, const Take& take) const {
  const MeshRange& range = ranges_[mesh];
  const std::vector<std::uint32_t>& indices = scene.meshes[mesh].indices;
  if (range.opaque || order_ == DrawOrder::Forward) {
    const std::uint64_t first = range.opaque ? range.firstOpaqueIndex : range.firstTransparentIndex;
    take(first * sizeof(std::uint32_t), std::as_bytes(std::span(indices)));
  }
  if (range.transparent && order_ != DrawOrder::Forward) {
    const std::vector<std::uint32_t> reordered = submittedIndices(scene, mesh);
    take(range.firstTransparentIndex * sizeof(std::uint32_t), std::as_bytes(std::span(reordered)));
  }
}

glm::mat4 SceneDraws::placeOf(const Scene& scene, std::uint32_t instance) const {
  return placed(scene.draws[sources_[instance]].transform, origin_);
}

// In pieces: there may be millions.
void SceneDraws::giveInstances(const Scene& scene, const Take& take) const {
  constexpr std::size_t kPiece = 100'000;
  const std::size_t count = instanceCount();
  std::vector<std::array<glm::vec4, 3>> rows;
  static_assert(sizeof(rows[0]) == kInstanceBytes);
  for (std::size_t first = 0; first < count; first += kPiece) {
    rows.clear();
    for (std::size_t i = first; i < std::min(first + kPiece, count); ++i) {
      rows.push_back(rowsOf(placeOf(scene, static_cast<std::uint32_t>(i))));
    }
    take(first * kInstanceBytes, std::as_bytes(std::span(rows)));
  }
}

// The draw of a group whose instances come next.
GpuDraw SceneDraws::describe(const Scene& scene, const DrawGroup& group, bool transparent) const {
  const Material& material = scene.materials[group.material];
  const Mesh& mesh = scene.meshes[group.mesh];
  const MeshRange& range = ranges_[group.mesh];
  GpuDraw draw;
  draw.mesh = group.mesh;
  draw.material = group.material;
  draw.firstIndex = static_cast<std::uint32_t>(transparent ? range.firstTransparentIndex : range.firstOpaqueIndex);
  draw.indexCount = static_cast<std::uint32_t>(mesh.indices.size());
  draw.firstInstance = static_cast<std::uint32_t>(sources_.size());
  draw.instanceCount = static_cast<std::uint32_t>(group.draws.size());
  draw.features = featuresOf(scene, material, mesh, isPremultiplied(group.material));
  if (solids_.of(group.mesh, group.material) != Facing::Open) draw.features |= shaders::FEATURE_SOLID;
  draw.mirrored = group.mirrored;
  draw.backFaceCulled = !transparent && !material.doubleSided;
  return draw;
}

void SceneDraws::listDraws(const Scene& scene, bool allTransparent) {
  sources_.reserve(scene.draws.size());
  for (const bool transparent : {false, true}) {
    std::vector<DrawGroup> groups = groupDraws(scene, transparent, allTransparent);
    if (transparent) reorderGroups(groups, order_);
    for (const DrawGroup& group : groups) {
      (transparent ? transparent_ : opaque_).push_back(describe(scene, group, transparent));
      sources_.insert(sources_.end(), group.draws.begin(), group.draws.end());
    }
  }
  orderOpaque(opaque_, [](const GpuDraw& draw) { return std::pair(draw.features, draw.material); });
}

void SceneDraws::placeBoxes(const Scene& scene) {
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
