// The vertices of all meshes in the GPU's memory: an array for each attribute, in which a mesh that does not have it
// takes no room.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "../gpu/pipeline.h"
#include "../gpu/resources.h"
#include "../gpu/upload.h"
#include "../scene/scene.h"

namespace vitrail::tool {

// The bindings of surface.vert: an attribute each, in the order of Mesh's arrays, and the instances' transforms.
constexpr std::uint32_t kStreamCount = 6;
constexpr std::uint32_t kInstanceBinding = kStreamCount;
constexpr std::uint32_t kInstanceBytes = 48; // three rows of four floats

// What surface.vert reads of them.
VertexLayout surfaceVertexLayout();

class VertexStreams {
 public:
  // Where a mesh's attributes begin. An attribute that it does not have has stride 0: one value for all vertices.
  struct Place {
    std::array<VkDeviceSize, kStreamCount> offsets{};
    std::array<VkDeviceSize, kStreamCount> strides{};
  };

  // Makes room for the meshes of a scene that are `used`. Throws GpuError.
  VertexStreams(Gpu& gpu, const Scene& scene, const std::vector<bool>& used);

  // Copies a mesh's vertices. `released`: the same mesh, whose arrays are let go of as they have been copied; or null.
  void upload(Uploader& uploader, const Mesh& mesh, std::size_t index, Mesh* released);

  const Place& place(std::size_t mesh) const { return places_[mesh]; }
  // Binds a mesh's vertices, all bindings but the instances'.
  void cmdBind(VkCommandBuffer commands, std::size_t mesh) const;

 private:
  std::vector<Place> places_;
  std::array<GpuBuffer, kStreamCount> buffers_;
};

} // namespace vitrail::tool
