// EXT_mesh_gpu_instancing: where the copies of a node's mesh are.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "document.h"
#include "nodes.h"

namespace vitrail::tool {

// From the space of each copy to that of the node; none where the node has no such copies but one of its own. Throws
// LoadError; warns of rotations that are none.
std::vector<glm::dmat4> instancesOf(const GltfDocument& document, const GltfPlacedNode& placed, Scene& scene);

} // namespace vitrail::tool
