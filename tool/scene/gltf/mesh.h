// Turns one glTF primitive into a mesh, in the rest pose of the node that shows it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "../scene.h"
#include "document.h"
#include "material.h"

namespace vitrail::tool {

// What a node adds to the meshes that it shows.
struct GltfPose {
  std::span<const double> weights;   // of the mesh's morph targets
  std::optional<std::size_t> skin;   // the mesh is then placed in the world already
  std::span<const glm::dmat4> nodes; // the world transforms of all nodes
};

class GltfMeshReader {
 public:
  explicit GltfMeshReader(const GltfDocument& document);

  // The mesh of one primitive. Throws LoadError.
  Mesh read(std::size_t mesh, std::size_t primitive, const GltfMaterial& material, const GltfPose& pose);

 private:
  void take(std::uint64_t elements);

  const GltfDocument& document_;
  std::uint64_t budget_; // how many more vertices and indices the file may make
};

// True where the primitive follows the joints of the node's skin.
bool isSkinned(const tinygltf::Primitive& primitive, const tinygltf::Node& node);

} // namespace vitrail::tool
