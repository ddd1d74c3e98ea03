// Questions about a whole scene.
#include "scene.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

namespace vitrail::tool {
namespace {

// Which vertices a mesh shows: a file may hold others, and they are not part of the picture. Empty: all of them.
std::vector<bool> usedVertices(const Mesh& mesh) {
  std::vector<bool> used(mesh.vertexCount(), false);
  for (const std::uint32_t index : mesh.indices) used[index] = true;
  return std::ranges::find(used, false) == used.end() ? std::vector<bool>() : used;
}

// What of a mesh is placed once a draw: its vertices, or the corners of the box around them.
class Shape {
 public:
  Shape(const Mesh& mesh, bool box) {
    if (mesh.indices.empty()) return;
    if (box) {
      corners_ = cornersOf(boundsOf(mesh));
      points_ = corners_;
    } else {
      used_ = usedVertices(mesh);
      points_ = mesh.positions;
    }
  }
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;

  void place(const glm::mat4& transform, const std::function<void(std::span<const glm::vec3>)>& visit) const {
    std::array<glm::vec3, 1024> placed;
    std::size_t count = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!used_.empty() && !used_[i]) continue;
      placed[count++] = glm::vec3(transform * glm::vec4(points_[i], 1.0F));
      if (count < placed.size()) continue;
      visit(placed);
      count = 0;
    }
    if (count > 0) visit(std::span(placed).first(count));
  }

 private:
  std::vector<bool> used_;
  std::array<glm::vec3, 8> corners_{};
  std::span<const glm::vec3> points_;
};

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
  constexpr std::uint64_t mostPlaced = 50'000'000; // takes a second or so
  std::uint64_t placed = 0;
  for (const Draw& draw : scene.draws) placed += scene.meshes[draw.mesh].vertexCount();
  std::vector<std::unique_ptr<Shape>> shapes(scene.meshes.size());
  for (const Draw& draw : scene.draws) {
    std::unique_ptr<Shape>& shape = shapes[draw.mesh];
    if (!shape) shape = std::make_unique<Shape>(scene.meshes[draw.mesh], placed > mostPlaced);
    shape->place(draw.transform, visit);
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
