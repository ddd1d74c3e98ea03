// What is drawn of a scene, by whatever API: draws with their instances, where each is, and where the indices of its
// mesh lie. No graphics API.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "../scene/scene.h"
#include "../scene/volume.h"
#include "draw_groups.h"
#include "draw_order.h"

namespace vitrail::tool {

// Some instances of one mesh with one material: one indexed draw.
struct GpuDraw {
  std::uint32_t mesh = 0;     // index into Scene::meshes
  std::uint32_t material = 0; // index into Scene::materials
  std::uint32_t firstIndex = 0;
  std::uint32_t indexCount = 0;
  std::uint32_t firstInstance = 0; // among all instances
  std::uint32_t instanceCount = 0;
  std::uint32_t features = 0;  // of its pipeline, surface_shared.h
  bool mirrored = false;       // its transforms turn triangles round, and what was outside stays so
  bool backFaceCulled = false; // else both sides are drawn
};

// A box and where it is.
struct PlacedBox {
  Bounds box;
  glm::mat4 model{1.0F}; // from the box's space to the GPU's
};

constexpr std::uint32_t kInstanceBytes = 48; // of an instance's transform as surface.vert takes it: rows of four floats

class SceneDraws {
 public:
  // With `opacity` every material is transparent. `order` is that of the transparent draws, and of the instances of
  // each. Throws GpuError where the scene has more of something than draws can count, or more than `mostVertices` in a
  // mesh.
  SceneDraws(const Scene& scene, std::optional<float> opacity, DrawOrder order, std::uint32_t mostVertices);

  const std::vector<GpuDraw>& opaqueDraws() const { return opaque_; } // opaque and alpha-masked
  const std::vector<GpuDraw>& transparentDraws() const { return transparent_; }
  // Boxes around all that is transparent: around each instance, or where there are very many around each draw.
  const std::vector<PlacedBox>& transparentBoxes() const { return boxes_; }
  // The draw of the scene that an instance stands for: an index into Scene::draws.
  std::uint32_t sourceOf(std::uint32_t instance) const { return sources_[instance]; }
  // Where an instance of the scene that this was made of is in the GPU's space.
  glm::mat4 placeOf(const Scene& scene, std::uint32_t instance) const;
  // The indices of transparent draw `i` in the order in which its triangles are submitted, relative to its vertices.
  // `scene` is what this was made of.
  std::vector<std::uint32_t> transparentIndices(const Scene& scene, std::size_t i) const;
  // What of the scene encloses a volume.
  const Solids& solids() const { return solids_; }
  float opacity() const { return opacity_; } // that all materials are blended with, else 1
  std::size_t instanceCount() const { return sources_.size(); }
  // The point of the world that is the GPU's (0, 0, 0): near the scene, so that a model far from the world's own origin
  // keeps its precision in 32-bit floats. Views are moved with it.
  const glm::dvec3& origin() const { return origin_; }

  // What the draws use, in rising order.
  const std::vector<std::uint32_t>& materials() const { return materials_; }
  bool usesMesh(std::size_t mesh) const { return ranges_[mesh].opaque || ranges_[mesh].transparent; }
  // Whether the base colour texture of a material is kept premultiplied: where its alpha counts and is not 1
  // everywhere.
  bool isPremultiplied(std::uint32_t material) const { return premultiplied_.contains(material); }

  // What a graphics API copies to the device: the transforms of all instances, kInstanceBytes each, some at a time;
  std::uint64_t instanceBytes() const { return instanceCount() * kInstanceBytes; }
  using Take = std::function<void(std::uint64_t offset, std::span<const std::byte> bytes)>;
  void giveInstances(const Scene& scene, const Take& take) const;
  // the 32-bit indices of all draws; those of a mesh, whose offsets are bytes.
  std::uint64_t indexBytes() const { return indexCount_ * sizeof(std::uint32_t); }
  void giveIndices(const Scene& scene, std::size_t mesh, const Take& take) const;

 private:
  // Where a mesh's indices lie in the pooled buffer.
  struct MeshRange {
    bool opaque = false; // whether any opaque, any transparent draw uses it
    bool transparent = false;
    std::uint64_t firstOpaqueIndex = 0;
    std::uint64_t firstTransparentIndex = 0;
  };

  void placeMeshes(const Scene& scene, bool allTransparent, std::uint32_t mostVertices);
  std::vector<std::uint32_t> submittedIndices(const Scene& scene, std::size_t mesh) const;
  GpuDraw describe(const Scene& scene, const DrawGroup& group, bool transparent) const;
  void listDraws(const Scene& scene, bool allTransparent);
  void placeBoxes(const Scene& scene);

  DrawOrder order_;
  Solids solids_;
  float opacity_;
  glm::dvec3 origin_;
  std::uint64_t indexCount_ = 0;
  std::vector<MeshRange> ranges_; // of each mesh
  std::vector<std::uint32_t> materials_;
  std::set<std::uint32_t> premultiplied_; // materials
  std::vector<std::uint32_t> sources_;    // of each instance
  std::vector<GpuDraw> opaque_;
  std::vector<GpuDraw> transparent_;
  std::vector<PlacedBox> boxes_;
};

} // namespace vitrail::tool
