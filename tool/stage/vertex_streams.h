// The vertices of all meshes in the GPU's memory, placed as vertex_places.h says.
#pragma once

#include <array>
#include <cstddef>

#include "../gpu/pipeline.h"
#include "../gpu/resources.h"
#include "../gpu/upload.h"
#include "../scene/scene.h"
#include "vertex_places.h"

namespace vitrail::tool {

// What surface.vert reads of them.
VertexLayout surfaceVertexLayout();

class VertexStreams {
 public:
  // Makes room for the meshes of a scene that are drawn. Throws GpuError.
  VertexStreams(Gpu& gpu, const Scene& scene, const SceneDraws& draws);

  // Copies a mesh's vertices. `released`: the same mesh, whose arrays are let go of as they have been copied; or null.
  void upload(Uploader& uploader, const Mesh& mesh, std::size_t index, Mesh* released);

  // Where they lie, for shaders that fetch vertices themselves.
  const VertexPlace& place(std::size_t mesh) const { return places_.meshes[mesh]; }
  const GpuBuffer& buffer(std::size_t stream) const { return buffers_[stream]; }

  // Binds a mesh's vertices, all bindings but the instances'.
  void cmdBind(VkCommandBuffer commands, std::size_t mesh) const;

 private:
  VertexPlaces places_;
  std::array<GpuBuffer, kStreamCount> buffers_;
};

} // namespace vitrail::tool
