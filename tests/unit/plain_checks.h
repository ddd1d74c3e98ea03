// What tests of OBJ, PLY and STL ask of a mesh.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>

#include <glm/glm.hpp>

#include "scene/load.h"

namespace vitrail::tool::test {

inline Vertex vertexAt(const Mesh& mesh, std::size_t i) { return mesh.vertex(i); }

// Of the corner that an index of the mesh stands for.
inline Vertex cornerAt(const Mesh& mesh, std::size_t index) { return vertexAt(mesh, mesh.indices.at(index)); }

// Half the cross product of two sides.
inline glm::vec3 triangleArea(const Mesh& mesh, std::size_t triangle) {
  const glm::vec3 a = cornerAt(mesh, 3 * triangle).position;
  return glm::cross(cornerAt(mesh, 3 * triangle + 1).position - a, cornerAt(mesh, 3 * triangle + 2).position - a) *
         0.5F;
}

inline Scene plyOf(const std::string& text) { return loadPly(std::as_bytes(std::span(text)), {}); }
inline Scene stlOf(const std::string& text) { return loadStl(std::as_bytes(std::span(text))); }

} // namespace vitrail::tool::test
