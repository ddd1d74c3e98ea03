// Questions about a whole scene.
#include "scene.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace vitrail::tool {
namespace {

// The positions that a mesh's triangles use: a file may hold others, and they are not part of the picture.
std::vector<glm::vec3> usedPositions(const Mesh& mesh) {
  std::vector<bool> used(mesh.vertexCount(), false);
  for (const std::uint32_t index : mesh.indices) used[index] = true;
  std::vector<glm::vec3> positions;
  positions.reserve(mesh.vertexCount());
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) positions.push_back(mesh.positions[i]);
  }
  return positions;
}

} // namespace

Bounds boundsOf(const Mesh& mesh) {
  const glm::vec3& first = mesh.positions[mesh.indices.front()];
  Bounds bounds{first, first};
  for (const std::uint32_t index : mesh.indices) {
    bounds.min = glm::min(bounds.min, mesh.positions[index]);
    bounds.max = glm::max(bounds.max, mesh.positions[index]);
  }
  return bounds;
}

std::array<glm::vec3, 8> cornersOf(const Bounds& bounds) {
  std::array<glm::vec3, 8> corners;
  for (unsigned i = 0; i < 8; ++i) {
    corners[i] = {(i & 1U) != 0 ? bounds.max.x : bounds.min.x, (i & 2U) != 0 ? bounds.max.y : bounds.min.y,
                  (i & 4U) != 0 ? bounds.max.z : bounds.min.z};
  }
  return corners;
}

bool isTransparent(const Material& material) {
  return material.alphaMode == AlphaMode::Blend || (material.transmission > 0.0F && !material.unlit);
}

void warn(Scene& scene, std::string line) {
  if (std::ranges::find(scene.warnings, line) == scene.warnings.end()) scene.warnings.push_back(std::move(line));
}

void visitPositions(const Scene& scene, const std::function<void(std::span<const glm::vec3>)>& visit) {
  std::vector<std::vector<glm::vec3>> positions(scene.meshes.size());
  std::vector<glm::vec3> placed;
  for (const Draw& draw : scene.draws) {
    std::vector<glm::vec3>& used = positions[draw.mesh];
    if (used.empty()) used = usedPositions(scene.meshes[draw.mesh]);
    placed.resize(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) placed[i] = glm::vec3(draw.transform * glm::vec4(used[i], 1.0F));
    visit(placed);
  }
}

Bounds worldBounds(const Scene& scene) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Bounds bounds{glm::vec3(infinity), glm::vec3(-infinity)};
  visitPositions(scene, [&bounds](std::span<const glm::vec3> positions) {
    for (const glm::vec3& position : positions) {
      bounds.min = glm::min(bounds.min, position);
      bounds.max = glm::max(bounds.max, position);
    }
  });
  return bounds.min.x <= bounds.max.x ? bounds : Bounds{};
}

std::uint64_t triangleCount(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Draw& draw : scene.draws) {
    const Mesh& mesh = scene.meshes[draw.mesh];
    if (mesh.primitive == Primitive::Triangles) count += mesh.indices.size() / 3;
  }
  return count;
}

} // namespace vitrail::tool
