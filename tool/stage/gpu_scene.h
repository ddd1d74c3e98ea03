// A scene in the GPU's memory: meshes, instances, materials and textures.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "../gpu/resources.h"
#include "../gpu/upload.h"
#include "../scene/scene.h"
#include "scene_draws.h"
#include "texture.h"
#include "vertex_streams.h"

namespace vitrail::tool {

// The largest alignment of a uniform buffer's offset that a device may ask for.
constexpr std::uint32_t kUniformAlignment = 256;
template <typename Data>
constexpr std::uint32_t kUniformStride = (sizeof(Data) + kUniformAlignment - 1) / kUniformAlignment* kUniformAlignment;

class GpuScene : public SceneDraws {
 public:
  // As SceneDraws. `released`: the same scene, whose geometry is let go of as it has been copied; or null. Throws
  // GpuError.
  GpuScene(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order, Scene* released = nullptr);

  const VertexStreams& streams() const { return *streams_; }
  const GpuBuffer& instances() const { return instances_; } // kInstanceBytes each
  const GpuBuffer& indices() const { return indices_; }     // 32-bit
  const GpuBuffer& materials() const { return materials_; } // of shaders::MaterialData, a stride apart
  const GpuBuffer& lights() const { return lights_; }       // of shaders::LightData; one at least
  std::uint32_t lightCount() const { return lightCount_; }
  void cmdBindInstances(VkCommandBuffer commands) const;
  VkDescriptorSetLayout textureLayout() const { return textures_->layout(); }
  // What a material samples, as a set, and slot by slot.
  VkDescriptorSet textures(std::uint32_t material) const { return textures_->set(material); }
  const TextureSet& sampled(std::uint32_t material) const { return textures_->sampled(material); }

 private:
  void uploadMeshes(Uploader& uploader, const Scene& scene, Scene* released);
  void uploadMaterials(Uploader& uploader, const Scene& scene, std::optional<float> opacity);
  void uploadLights(Uploader& uploader, const Scene& scene);
  void uploadInstances(Uploader& uploader, const Scene& scene);

  Gpu& gpu_;
  std::optional<VertexStreams> streams_;
  GpuBuffer indices_;
  GpuBuffer instances_;
  GpuBuffer materials_;
  GpuBuffer lights_;
  std::uint32_t lightCount_ = 0;
  std::unique_ptr<MaterialTextures> textures_;
};

} // namespace vitrail::tool
