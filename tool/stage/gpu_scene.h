// A scene in the GPU's memory: meshes, draws, materials and textures, and what each draw has to bind.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "../gpu/resources.h"
#include "../gpu/upload.h"
#include "../scene/scene.h"
#include "../scene/volume.h"
#include "draw_groups.h"
#include "draw_order.h"
#include "texture.h"
#include "vertex_streams.h"

namespace vitrail::tool {

// The largest alignment of a uniform buffer's offset that a device may ask for.
constexpr std::uint32_t kUniformAlignment = 256;
template <typename Data>
constexpr std::uint32_t kUniformStride = (sizeof(Data) + kUniformAlignment - 1) / kUniformAlignment* kUniformAlignment;

// Some instances of one mesh with one material: one indexed draw.
struct GpuDraw {
  std::uint32_t mesh = 0;           // index into Scene::meshes
  std::uint32_t materialOffset = 0; // bytes into materials()
  std::uint32_t firstIndex = 0;
  std::uint32_t indexCount = 0;
  std::uint32_t firstInstance = 0; // among all instances; gl_InstanceIndex counts from there
  std::uint32_t instanceCount = 0;
  std::uint32_t features = 0; // of its pipeline, surface_shared.h
  VkDescriptorSet textures = VK_NULL_HANDLE;
  VkFrontFace frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  VkCullModeFlags cullMode = VK_CULL_MODE_NONE;
};

// A box and where it is.
struct PlacedBox {
  Bounds box;
  glm::mat4 model{1.0F}; // from the box's space to the GPU's
};

class GpuScene {
 public:
  // With `opacity` every material is transparent. `order` is that of the transparent draws, and of the instances of
  // each. `released`: the same scene, whose geometry is let go of as it has been copied; or null. Throws GpuError.
  GpuScene(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order, Scene* released = nullptr);

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
  const VertexStreams& streams() const { return *streams_; }
  const GpuBuffer& indices() const { return indices_; }     // 32-bit
  const GpuBuffer& materials() const { return materials_; } // of shaders::MaterialData, a stride apart
  const GpuBuffer& lights() const { return lights_; }       // of shaders::LightData; one at least
  std::uint32_t lightCount() const { return lightCount_; }
  // What of the scene encloses a volume.
  const Solids& solids() const { return solids_; }
  float opacity() const { return opacity_; } // that all materials are blended with, else 1
  std::size_t instanceCount() const { return sources_.size(); }
  void cmdBindInstances(VkCommandBuffer commands) const;
  // The point of the world that is the GPU's (0, 0, 0): near the scene, so that a model far from the world's own origin
  // keeps its precision in 32-bit floats. Views are moved with it.
  const glm::dvec3& origin() const { return origin_; }
  VkDescriptorSetLayout textureLayout() const { return textures_->layout(); }

 private:
  // Where a mesh's indices lie in the pooled buffer.
  struct MeshRange {
    bool opaque = false; // whether any opaque, any transparent draw uses it
    bool transparent = false;
    std::uint64_t firstOpaqueIndex = 0;
    std::uint64_t firstTransparentIndex = 0;
  };

  std::vector<MeshRange> placeMeshes(const Scene& scene, bool allTransparent);
  void uploadMeshes(Uploader& uploader, const Scene& scene, const std::vector<MeshRange>& ranges, Scene* released);
  std::vector<std::uint32_t> submittedIndices(const Scene& scene, std::size_t mesh) const;
  void uploadMaterials(Uploader& uploader, const Scene& scene, std::optional<float> opacity);
  void uploadLights(Uploader& uploader, const Scene& scene);
  void uploadInstances(Uploader& uploader, const Scene& scene);
  GpuDraw describe(const Scene& scene, const DrawGroup& group, const MeshRange& range, bool transparent) const;
  void listDraws(const Scene& scene, const std::vector<MeshRange>& ranges, bool allTransparent);
  void placeBoxes(const Scene& scene);

  Gpu& gpu_;
  DrawOrder order_;
  Solids solids_;
  float opacity_ = 1.0F;
  glm::dvec3 origin_{0.0};
  std::uint64_t indexCount_ = 0;
  std::optional<VertexStreams> streams_;
  GpuBuffer indices_;
  GpuBuffer instances_; // kInstanceBytes each
  GpuBuffer materials_;
  GpuBuffer lights_;
  std::uint32_t lightCount_ = 0;
  std::unique_ptr<MaterialTextures> textures_;
  std::vector<std::uint32_t> sources_; // of each instance
  std::vector<GpuDraw> opaque_;
  std::vector<GpuDraw> transparent_;
  std::vector<PlacedBox> boxes_;
};

} // namespace vitrail::tool
