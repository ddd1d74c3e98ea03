// Turns one glTF primitive into a mesh, in the pose of the node that shows it.
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
#include "skin.h"

namespace vitrail::tool {

// What a node adds to the meshes that it shows.
struct GltfPose {
  std::span<const double> weights;    // of the mesh's morph targets
  const GltfSkinPose* skin = nullptr; // the mesh is then placed in the world already, but for the skin's origin
};

class GltfMeshReader {
 public:
  explicit GltfMeshReader(const GltfDocument& document);

  // The mesh of one primitive. Throws LoadError.
  Mesh read(std::size_t mesh, std::size_t primitive, const GltfMaterial& material, const GltfPose& pose);

 private:
  void take(std::uint64_t elements);
  std::vector<Vertex> posedVertices(const tinygltf::Primitive& source, const GltfMaterial& material,
                                    const GltfPose& pose, const std::string& where) const;

  const GltfDocument& document_;
  std::uint64_t budget_; // how many more vertices and indices the file may make
};

// True where the primitive follows the joints of a skin, if its node has one.
bool canFollowJoints(const tinygltf::Primitive& primitive);

} // namespace vitrail::tool
