// The node hierarchy of a glTF file: a forest, and where each node is in the world.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/glm.hpp>

#include "document.h"

namespace vitrail::tool {

// The world transform of every node, whether or not a scene uses it: joints of a skin may lie outside. Throws LoadError
// where a node has two parents, is its own ancestor, or has a transform that is none.
std::vector<glm::dmat4> placeNodes(const GltfDocument& document);

// The nodes of the scene to draw: the default scene, scene 0 where none is named, every tree where there are no scenes.
// Parents come before their children, and children in the file's order.
std::vector<std::size_t> sceneNodes(const GltfDocument& document);

// The matrix in single precision. Throws LoadError that names the node where that cannot hold it.
glm::mat4 nodeMatrix(const GltfDocument& document, std::size_t node, const glm::dmat4& world);

// How a message names a node.
std::string nodeName(const GltfDocument& document, std::size_t node);

} // namespace vitrail::tool
