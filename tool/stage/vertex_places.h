// The vertices of all meshes as arrays on a device: one for each attribute, in which a mesh that does not have it takes
// no room. No graphics API.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../scene/scene.h"
#include "scene_draws.h"

namespace vitrail::tool {

// The bindings of surface.vert: an attribute each, in the order of Mesh's arrays, and the instances' transforms.
constexpr std::uint32_t kStreamCount = 6;
constexpr std::uint32_t kInstanceBinding = kStreamCount;

// Of each array: its name, and the bytes of a vertex.
extern const std::array<const char*, kStreamCount> kStreamNames;
inline constexpr std::array<std::uint32_t, kStreamCount> kStreamBytes{sizeof(glm::vec3),     sizeof(std::uint32_t),
                                                                      sizeof(std::uint32_t), sizeof(glm::vec2),
                                                                      sizeof(glm::vec2),     sizeof(std::uint64_t)};

// A mesh's arrays; empty where it does not have the attribute.
std::array<std::span<const std::byte>, kStreamCount> vertexArrays(const Mesh& mesh);
// Lets go of one of them.
void releaseArray(Mesh& mesh, std::size_t stream);

// A mesh of one vertex that has everything, with the values of a vertex that has nothing: each array begins with it.
Mesh defaultVertex();

// Where a mesh's attributes begin. An attribute that it does not have has stride 0: one value for all vertices.
struct VertexPlace {
  std::array<std::uint64_t, kStreamCount> offsets{};
  std::array<std::uint64_t, kStreamCount> strides{};
  std::uint32_t vertices = 0;
};

struct VertexPlaces {
  std::vector<VertexPlace> meshes;
  std::array<std::uint64_t, kStreamCount> bytes{}; // of each array
};

// Of the meshes that are drawn.
VertexPlaces placeVertices(const Scene& scene, const SceneDraws& draws);

} // namespace vitrail::tool
