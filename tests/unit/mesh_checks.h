// What scene.h promises of a mesh, as questions that tests ask.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace vitrail::tool::test {

inline bool isUnit(const glm::vec3& vector) { return std::abs(glm::length(vector) - 1.0F) < 1e-5F; }

// Empty: the mesh is sound. Else what is wrong with it.
inline std::string meshFault(const Mesh& mesh) {
  if (mesh.indices.empty() || mesh.indices.size() % 3 != 0) return "not a list of triangles";
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    const Vertex vertex = mesh.vertex(i);
    const std::string which = " of vertex " + std::to_string(i);
    if (!isUnit(vertex.normal)) return "the length of the normal" + which;
    if (!isUnit(glm::vec3(vertex.tangent))) return "the length of the tangent" + which;
    if (std::abs(glm::dot(glm::vec3(vertex.tangent), vertex.normal)) > 1e-3F) return "the tangent's direction" + which;
    if (std::abs(vertex.tangent.w) != 1.0F) return "the tangent's sign" + which;
  }
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    glm::dvec3 position[3];
    glm::dvec3 normals(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh.indices[i + k] >= mesh.vertexCount()) return "index " + std::to_string(i + k);
      position[k] = glm::dvec3(mesh.positions[mesh.indices[i + k]]);
      normals += glm::dvec3(mesh.vertex(mesh.indices[i + k]).normal);
    }
    const glm::dvec3 face = glm::cross(position[1] - position[0], position[2] - position[0]);
    if (!(glm::length(face) > 0.0)) return "no area in triangle " + std::to_string(i / 3);
    if (!(glm::dot(face, normals) > 0.0)) return "the winding of triangle " + std::to_string(i / 3);
  }
  return {};
}

// The number of triangle edges without exactly one partner that runs the other way between the same two positions,
// bit for bit. 0: the surface is closed.
inline std::size_t openEdges(const Mesh& mesh) {
  using Point = std::tuple<float, float, float>;
  std::map<Point, std::size_t> welded;
  std::vector<std::size_t> index;
  for (const Vertex& vertex : mesh.vertices()) {
    // Adding 0 makes one zero of the two.
    const Point point(vertex.position.x + 0.0F, vertex.position.y + 0.0F, vertex.position.z + 0.0F);
    index.push_back(welded.emplace(point, welded.size()).first->second);
  }
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> edges;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++edges[{index[mesh.indices[i + k]], index[mesh.indices[i + (k + 1) % 3]]}];
    }
  }
  std::size_t open = 0;
  for (const auto& [edge, count] : edges) {
    const auto partner = edges.find({edge.second, edge.first});
    if (count != 1 || partner == edges.end() || partner->second != 1) open += count;
  }
  return open;
}

// The volume of a closed mesh; positive where its triangles are counter-clockwise from outside.
inline double signedVolume(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a(mesh.positions[mesh.indices[i]]);
    const glm::dvec3 b(mesh.positions[mesh.indices[i + 1]]);
    const glm::dvec3 c(mesh.positions[mesh.indices[i + 2]]);
    sum += glm::dot(a, glm::cross(b, c));
  }
  return sum / 6.0;
}

} // namespace vitrail::tool::test
