// Simple bodies with normals, tangents and texture coordinates, for the built-in scenes.
// All of them keep scene.h's promises: counter-clockwise from outside, unit normals, no triangle without an area.
// Shared edges have bit-equal positions on both sides, also across a texture seam, so closed bodies have no cracks.
// Texture coordinates run right (u) and down (v) as seen from outside.
#pragma once

#include <cstdint>
#include <span>

#include "../scene.h"

namespace vitrail::tool {

// One point of a profile curve in the half plane right of the Y axis.
struct ProfilePoint {
  float radius = 0.0F; // 0: on the axis, allowed for the first and the last point only
  float height = 0.0F;
  glm::vec2 normal{1.0F, 0.0F}; // outward: along the radius, along the height; any length above 0
};

// Turns a profile, given from top to bottom, around the Y axis. Two points at the same place make a sharp edge.
Mesh lathe(std::span<const ProfilePoint> profile, std::uint32_t segments);

// A sphere of radius 1 around the origin.
Mesh uvSphere(std::uint32_t segments, std::uint32_t rings);

// Half spheres at heights halfLength and -halfLength, each of capRings rings, joined by the cone that touches both. The
// radii differ by less than 2 * halfLength; equal ones make a capsule.
Mesh capsule(float topRadius, float bottomRadius, float halfLength, std::uint32_t segments, std::uint32_t capRings);

// An upright cylinder with a rounded rim, from height -halfHeight to halfHeight. bevel < radius and bevel < halfHeight.
Mesh disc(float radius, float halfHeight, float bevel, std::uint32_t segments);

// A ring around the Y axis: a circle of tubeRadius at distance radius.
Mesh torus(float radius, float tubeRadius, std::uint32_t segments, std::uint32_t sides);

// A rectangle in the XY plane around the origin that faces +Z: two triangles.
Mesh quad(float halfWidth, float halfHeight);

// A tube along a curve of at least two points that ends in a pyramid beyond both of them. radii has one radius a point.
// Its cross-sections do not twist (parallel transport). It has no texture coordinates.
Mesh tube(std::span<const glm::vec3> curve, std::span<const float> radii, std::uint32_t sides);

// Appends one mesh to another, unchanged.
void append(Mesh& mesh, const Mesh& part);

} // namespace vitrail::tool
