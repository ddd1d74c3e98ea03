// Small scenes that tests put together by hand.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "../../tool/scene/camera.h"
#include "../../tool/scene/scene.h"

namespace vitrail::tool::reference {

// An unlit material that shows exactly `color`: linear, straight alpha.
Material unlitMaterial(const glm::vec4& color, AlphaMode mode = AlphaMode::Blend);

// An axis-aligned rectangle at one height z that faces +Z.
struct Rectangle {
  glm::vec2 low{-1.0F};
  glm::vec2 high{1.0F};
  float z = 0.0F;
};

// Adds a rectangle of two triangles as a mesh, a material and a draw of its own. Returns the index of the draw.
std::uint32_t addRectangle(Scene& scene, const Rectangle& rectangle, const Material& material);

// Calls `change` with each vertex of a mesh, and keeps what it makes of it.
template <typename Change>
void changeVertices(Mesh& mesh, Change change) {
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    Vertex vertex = mesh.vertex(i);
    change(vertex);
    mesh.set(i, vertex);
  }
}

// An orthographic view along -Z of heights -1 to 1. It sees z from 9 down to -9.
View straightView();

// A perspective view along -Z from the origin with a vertical field of view of 90 degrees: at distance d it sees
// heights -d to d. Near plane at 0.5, no far plane.
View wideView();

} // namespace vitrail::tool::reference
