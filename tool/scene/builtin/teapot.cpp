// The teapot's control points and their tessellation. Rim, body, lid and bottom are Newell's points for a quarter turn,
// turned three times more; handle and spout are his points for one side, mirrored. That gives all 306 points of the
// data set, with bit-equal points wherever patches meet.
#include "teapot.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace vitrail::tool {
namespace {

// Newell's coordinates: z is up.
using Patch = std::array<std::array<glm::vec3, 4>, 4>; // [v][u]

// A ring of control points: the first on the x axis, the second (radius, -corner), the third (corner, -radius).
struct Ring {
  float radius;
  float corner;
  float height;
};

// Each is four rings, from v = 0 to v = 1.
constexpr std::array<std::array<Ring, 4>, 6> turnedPatches{{
    // Rim
    {{{1.4F, 0.784F, 2.4F}, {1.3375F, 0.749F, 2.53125F}, {1.4375F, 0.805F, 2.53125F}, {1.5F, 0.84F, 2.4F}}},
    // Body, upper and lower half
    {{{1.5F, 0.84F, 2.4F}, {1.75F, 0.98F, 1.875F}, {2.0F, 1.12F, 1.35F}, {2.0F, 1.12F, 0.9F}}},
    {{{2.0F, 1.12F, 0.9F}, {2.0F, 1.12F, 0.45F}, {1.5F, 0.84F, 0.225F}, {1.5F, 0.84F, 0.15F}}},
    // Lid, knob and cover
    {{{0.0F, 0.0F, 3.15F}, {0.8F, 0.45F, 3.15F}, {0.0F, 0.0F, 2.85F}, {0.2F, 0.112F, 2.7F}}},
    {{{0.2F, 0.112F, 2.7F}, {0.4F, 0.224F, 2.55F}, {1.3F, 0.728F, 2.55F}, {1.3F, 0.728F, 2.4F}}},
    // Bottom
    {{{1.5F, 0.84F, 0.15F}, {1.5F, 0.84F, 0.075F}, {1.425F, 0.798F, 0.0F}, {0.0F, 0.0F, 0.0F}}},
}};

// The half with negative y; u = 0 and u = 1 are in the plane y = 0.
constexpr std::array<Patch, 4> mirroredPatches{{
    // Handle, upper and lower half
    {{{{{-1.6F, 0.0F, 2.025F}, {-1.6F, -0.3F, 2.025F}, {-1.5F, -0.3F, 2.25F}, {-1.5F, 0.0F, 2.25F}}},
      {{{-2.3F, 0.0F, 2.025F}, {-2.3F, -0.3F, 2.025F}, {-2.5F, -0.3F, 2.25F}, {-2.5F, 0.0F, 2.25F}}},
      {{{-2.7F, 0.0F, 2.025F}, {-2.7F, -0.3F, 2.025F}, {-3.0F, -0.3F, 2.25F}, {-3.0F, 0.0F, 2.25F}}},
      {{{-2.7F, 0.0F, 1.8F}, {-2.7F, -0.3F, 1.8F}, {-3.0F, -0.3F, 1.8F}, {-3.0F, 0.0F, 1.8F}}}}},
    {{{{{-2.7F, 0.0F, 1.8F}, {-2.7F, -0.3F, 1.8F}, {-3.0F, -0.3F, 1.8F}, {-3.0F, 0.0F, 1.8F}}},
      {{{-2.7F, 0.0F, 1.575F}, {-2.7F, -0.3F, 1.575F}, {-3.0F, -0.3F, 1.35F}, {-3.0F, 0.0F, 1.35F}}},
      {{{-2.5F, 0.0F, 1.125F}, {-2.5F, -0.3F, 1.125F}, {-2.65F, -0.3F, 0.9375F}, {-2.65F, 0.0F, 0.9375F}}},
      {{{-2.0F, 0.0F, 0.9F}, {-2.0F, -0.3F, 0.9F}, {-1.9F, -0.3F, 0.6F}, {-1.9F, 0.0F, 0.6F}}}}},
    // Spout, lower and upper half
    {{{{{1.7F, 0.0F, 1.425F}, {1.7F, -0.66F, 1.425F}, {1.7F, -0.66F, 0.6F}, {1.7F, 0.0F, 0.6F}}},
      {{{2.6F, 0.0F, 1.425F}, {2.6F, -0.66F, 1.425F}, {3.1F, -0.66F, 0.825F}, {3.1F, 0.0F, 0.825F}}},
      {{{2.3F, 0.0F, 2.1F}, {2.3F, -0.25F, 2.1F}, {2.4F, -0.25F, 2.025F}, {2.4F, 0.0F, 2.025F}}},
      {{{2.7F, 0.0F, 2.4F}, {2.7F, -0.25F, 2.4F}, {3.3F, -0.25F, 2.4F}, {3.3F, 0.0F, 2.4F}}}}},
    {{{{{2.7F, 0.0F, 2.4F}, {2.7F, -0.25F, 2.4F}, {3.3F, -0.25F, 2.4F}, {3.3F, 0.0F, 2.4F}}},
      {{{2.8F, 0.0F, 2.475F}, {2.8F, -0.25F, 2.475F}, {3.525F, -0.25F, 2.49375F}, {3.525F, 0.0F, 2.49375F}}},
      {{{2.9F, 0.0F, 2.475F}, {2.9F, -0.15F, 2.475F}, {3.45F, -0.15F, 2.5125F}, {3.45F, 0.0F, 2.5125F}}},
      {{{2.8F, 0.0F, 2.4F}, {2.8F, -0.15F, 2.4F}, {3.2F, -0.15F, 2.4F}, {3.2F, 0.0F, 2.4F}}}}},
}};

// Newell's z-up coordinates to Y up, in the scene's right-handed axes.
glm::vec3 yUp(const glm::vec3& point) { return {point.x, point.z, -point.y}; }

// The quarter number 0 to 3 of a patch of revolution. Each is the one before, turned by (x, y) -> (y, -x).
Patch quarterTurn(const std::array<Ring, 4>& rings, unsigned quarter) {
  Patch patch;
  for (std::size_t v = 0; v < 4; ++v) {
    const Ring& ring = rings[v];
    patch[v] = {{{ring.radius, 0.0F, ring.height},
                 {ring.radius, -ring.corner, ring.height},
                 {ring.corner, -ring.radius, ring.height},
                 {0.0F, -ring.radius, ring.height}}};
    for (glm::vec3& point : patch[v]) {
      for (unsigned turn = 0; turn < quarter; ++turn) point = {point.y, -point.x, point.z};
    }
  }
  return patch;
}

// De Casteljau's construction. std::lerp returns its ends exactly, and equal ends whatever t is: edges that patches
// share stay closed, and the poles of lid and bottom are one point.
glm::vec3 curvePoint(const std::array<glm::vec3, 4>& control, float t) {
  glm::vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<float, 4> value{control[0][axis], control[1][axis], control[2][axis], control[3][axis]};
    for (std::size_t last = 3; last > 0; --last) {
      for (std::size_t i = 0; i < last; ++i) value[i] = std::lerp(value[i], value[i + 1], t);
    }
    result[axis] = value[0];
  }
  return result;
}

glm::vec3 surfacePoint(const Patch& patch, float u, float v) {
  return curvePoint(
      {curvePoint(patch[0], u), curvePoint(patch[1], u), curvePoint(patch[2], u), curvePoint(patch[3], u)}, v);
}

glm::vec3 curveDirection(const std::array<glm::vec3, 4>& control, float t) {
  const float s = 1.0F - t;
  return 3.0F * (s * s * (control[1] - control[0]) + 2.0F * s * t * (control[2] - control[1]) +
                 t * t * (control[3] - control[2]));
}

struct Directions {
  glm::vec3 alongU;
  glm::vec3 alongV;
};

Directions surfaceDirections(const Patch& patch, float u, float v) {
  std::array<glm::vec3, 4> row;
  std::array<glm::vec3, 4> rowDirection;
  for (std::size_t j = 0; j < 4; ++j) {
    row[j] = curvePoint(patch[j], u);
    rowDirection[j] = curveDirection(patch[j], u);
  }
  return {curvePoint(rowDirection, v), curveDirection(row, v)};
}

Vertex evaluate(const Patch& patch, float u, float v, float side) {
  Directions along = surfaceDirections(patch, u, v);
  // At a pole a whole edge is one point: the normal is that of a place next to it.
  if (along.alongU == glm::vec3(0.0F)) along = surfaceDirections(patch, u, v == 0.0F ? 1e-3F : 1.0F - 1e-3F);
  Vertex vertex;
  vertex.position = yUp(surfacePoint(patch, u, v));
  vertex.normal = glm::normalize(yUp(side * glm::cross(along.alongU, along.alongV)));
  vertex.tangent = glm::vec4(glm::normalize(yUp(along.alongU)), -side);
  vertex.texCoord0 = {u, v};
  vertex.texCoord1 = vertex.texCoord0;
  return vertex;
}

// side is +1 where the cross product of the directions of u and v points outward, else -1.
void addPatch(Mesh& mesh, const Patch& patch, float side, std::uint32_t steps) {
  const auto first = static_cast<std::uint32_t>(mesh.vertexCount());
  const auto at = [steps](std::uint32_t i) { return static_cast<float>(i) / static_cast<float>(steps); };
  for (std::uint32_t j = 0; j <= steps; ++j) {
    for (std::uint32_t i = 0; i <= steps; ++i) mesh.add(evaluate(patch, at(i), at(j), side));
  }
  const auto addTriangle = [&mesh, side](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (mesh.positions[a] == mesh.positions[b]) return; // at a pole
    if (mesh.positions[b] == mesh.positions[c]) return;
    if (mesh.positions[c] == mesh.positions[a]) return;
    if (side > 0.0F) {
      mesh.indices.insert(mesh.indices.end(), {a, b, c});
    } else {
      mesh.indices.insert(mesh.indices.end(), {a, c, b});
    }
  };
  for (std::uint32_t j = 0; j < steps; ++j) {
    for (std::uint32_t i = 0; i < steps; ++i) {
      const std::uint32_t corner = first + j * (steps + 1) + i;
      addTriangle(corner, corner + 1, corner + steps + 2);
      addTriangle(corner, corner + steps + 2, corner + steps + 1);
    }
  }
}

} // namespace

Mesh teapot(std::uint32_t steps) {
  Mesh mesh;
  for (const std::array<Ring, 4>& rings : turnedPatches) {
    for (unsigned quarter = 0; quarter < 4; ++quarter) addPatch(mesh, quarterTurn(rings, quarter), 1.0F, steps);
  }
  for (const Patch& patch : mirroredPatches) {
    addPatch(mesh, patch, 1.0F, steps);
    Patch mirrored = patch;
    for (auto& row : mirrored) {
      for (glm::vec3& point : row) point.y = -point.y;
    }
    addPatch(mesh, mirrored, -1.0F, steps);
  }
  return mesh;
}

} // namespace vitrail::tool
