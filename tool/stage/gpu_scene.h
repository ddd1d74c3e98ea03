// A scene in the GPU's memory: meshes, draws, materials and textures, and what each draw has to bind.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "../gpu/resources.h"
#include "../gpu/upload.h"
#include "../scene/scene.h"
#include "draw_order.h"
#include "texture.h"

namespace vitrail::tool {

// The largest alignment of a uniform buffer's offset that a device may ask for.
constexpr std::uint32_t kUniformStride = 256;

// One indexed draw of the pooled buffers.
struct GpuDraw {
  std::uint32_t source = 0;         // index into Scene::draws
  std::uint32_t dataOffset = 0;     // bytes into drawData()
  std::uint32_t materialOffset = 0; // bytes into materials()
  std::uint32_t firstIndex = 0;
  std::uint32_t indexCount = 0;
  std::int32_t vertexOffset = 0;
  std::uint32_t features = 0; // of its pipeline, surface_shared.h
  VkDescriptorSet textures = VK_NULL_HANDLE;
  VkFrontFace frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  VkCullModeFlags cullMode = VK_CULL_MODE_NONE;
};

// The box around a mesh, and where a draw puts it.
struct PlacedBox {
  Bounds box;
  glm::mat4 model{1.0F}; // from the mesh's space to the GPU's
};

class GpuScene {
 public:
  // With `opacity` every material is transparent. `order` is that of the transparent draws. Throws GpuError.
  GpuScene(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order);

  const std::vector<GpuDraw>& opaqueDraws() const { return opaque_; } // opaque and alpha-masked
  const std::vector<GpuDraw>& transparentDraws() const { return transparent_; }
  const std::vector<PlacedBox>& transparentBoxes() const { return boxes_; } // of those draws, in their order
  // The indices of transparent draw `i` in the order in which its triangles are submitted, relative to its vertices.
  // `scene` is what this was made of.
  std::vector<std::uint32_t> transparentIndices(const Scene& scene, std::size_t i) const;
  const GpuBuffer& vertices() const { return vertices_; }   // of Vertex
  const GpuBuffer& indices() const { return indices_; }     // 32-bit
  const GpuBuffer& drawData() const { return drawData_; }   // of shaders::DrawData, kUniformStride apart
  const GpuBuffer& materials() const { return materials_; } // of shaders::MaterialData, kUniformStride apart
  // The point of the world that is the GPU's (0, 0, 0): near the scene, so that a model far from the world's own origin
  // keeps its precision in 32-bit floats. Views are moved with it.
  const glm::dvec3& origin() const { return origin_; }
  VkDescriptorSetLayout textureLayout() const { return textures_->layout(); }

 private:
  // Where a mesh lies in the pooled buffers.
  struct MeshRange {
    bool opaque = false; // whether any opaque, any transparent draw uses it
    bool transparent = false;
    bool vertexColors = false;
    std::uint64_t firstVertex = 0;
    std::uint64_t firstOpaqueIndex = 0;
    std::uint64_t firstTransparentIndex = 0;
  };

  std::vector<MeshRange> placeMeshes(const Scene& scene, bool allTransparent, DrawOrder order);
  void uploadMeshes(Uploader& uploader, const Scene& scene, const std::vector<MeshRange>& ranges);
  std::vector<std::uint32_t> submittedIndices(const Scene& scene, std::size_t mesh) const;
  void uploadMaterials(Uploader& uploader, const Scene& scene, std::optional<float> opacity);
  void uploadDraws(Uploader& uploader, const Scene& scene);
  void listDraws(const Scene& scene, const std::vector<MeshRange>& ranges, bool allTransparent, DrawOrder order);
  void placeBoxes(const Scene& scene);

  Gpu& gpu_;
  DrawOrder order_;
  glm::dvec3 origin_{0.0};
  std::uint64_t vertexCount_ = 0;
  std::uint64_t indexCount_ = 0;
  GpuBuffer vertices_;
  GpuBuffer indices_;
  GpuBuffer drawData_;
  GpuBuffer materials_;
  std::unique_ptr<MaterialTextures> textures_;
  std::vector<GpuDraw> opaque_;
  std::vector<GpuDraw> transparent_;
  std::vector<PlacedBox> boxes_;
};

} // namespace vitrail::tool
