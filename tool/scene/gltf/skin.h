// Poses a skinned mesh: its vertices follow the joints of a skin.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "../scene.h"
#include "document.h"
#include "nodes.h"

namespace vitrail::tool {

// Where the joints of a skin carry what is bound to them.
struct GltfSkinPose {
  std::vector<glm::dmat4> joints; // from the space of the bound mesh to the world, relative to `origin`
  glm::dvec3 origin{0.0};         // 0 but for what is so far away that floats would lose it
};

// Throws LoadError.
GltfSkinPose poseSkin(const GltfDocument& document, const GltfHierarchy& hierarchy, std::size_t skin);

// Moves vertices, which are the primitive's in the file's order, to where the joints carry them. Up to eight joints
// move a vertex (JOINTS_0 and JOINTS_1); their weights are normalised, and a vertex without any stays where it is.
// Triangles that the skin turns inside out are turned back. `where` names the primitive in messages. Throws LoadError.
void applySkin(const GltfDocument& document, const GltfSkinPose& pose, const tinygltf::Primitive& primitive,
               const std::string& where, std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices);

} // namespace vitrail::tool
