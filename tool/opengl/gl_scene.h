// A scene in an OpenGL context: meshes, instances, materials and textures. What GpuScene is with Vulkan.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "../scene/scene.h"
#include "../stage/scene_draws.h"
#include "../stage/texels.h"
#include "../stage/vertex_places.h"
#include "objects.h"

namespace vitrail::tool {

class GlScene : public SceneDraws {
 public:
  // As SceneDraws. `released`: the same scene, whose geometry is let go of as it has been copied; or null. Throws
  // GpuError.
  GlScene(Gl& gl, const Scene& scene, std::optional<float> opacity, DrawOrder order, Scene* released = nullptr);

  std::size_t lightCount() const { return lightCount_; }
  // Binds what all draws read: vertex array, instances, indices, lights.
  void bind() const;
  // Binds what a draw reads; of what `before`, if anything, has bound, what differs.
  void bind(const GpuDraw& draw, const GpuDraw* before) const;

 private:
  using Slots =
      std::array<std::pair<GLuint, GLuint>, shaders::SLOT_COUNT>; // texture and sampler, 0 where there is none

  void makeVertexArray();
  void uploadMaterials(const Scene& scene, std::optional<float> opacity);
  void uploadTextures(const Scene& scene);
  void uploadMeshes(const Scene& scene, Scene* released);
  GLuint texture(const Scene& scene, std::uint32_t image, Texels texels);
  GLuint sampler(const Sampler& sampler);

  Gl& gl_;
  VertexPlaces places_;
  std::array<GlBuffer, kStreamCount> streams_;
  GlBuffer indices_;
  GlBuffer instances_;
  GlBuffer materials_;
  std::uint32_t materialStride_ = 0;
  GlBuffer lights_;
  std::size_t lightCount_ = 0;
  GlObject vertexArray_;
  std::map<std::pair<std::uint32_t, Texels>, GlTexture> textures_; // by image
  std::vector<std::pair<Sampler, GlObject>> samplers_;
  std::map<std::uint32_t, Slots> slots_; // by material
};

} // namespace vitrail::tool
