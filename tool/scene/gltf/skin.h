// Poses a skinned mesh: its vertices follow the joints of a skin as they stand in the file.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "../scene.h"
#include "document.h"

namespace vitrail::tool {

// Moves vertices, which are the primitive's in the file's order, to where the skin's joints carry it in the
// world. `nodes` holds all nodes' world transforms. Up to eight joints move a vertex (JOINTS_0 and JOINTS_1); their
// weights are normalised, and a vertex without any stays where it is. Triangles that the skin turns inside out are
// turned back. `where` names the primitive in messages. Throws LoadError.
void applySkin(const GltfDocument& document, std::span<const glm::dmat4> nodes, std::size_t skin,
               const tinygltf::Primitive& primitive, const std::string& where, std::vector<Vertex>& vertices,
               std::vector<std::uint32_t>& indices);

} // namespace vitrail::tool
