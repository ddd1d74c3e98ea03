// Makes meshes that keep the promises of scene.h out of what files hold: triangle lists without degenerate triangles,
// unit normals and tangents, no unused vertices. And checks that a loaded scene can be drawn.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene.h"

namespace vitrail::tool {

enum class Topology { Triangles, Strip, Fan };
enum class LineTopology { Lines, Strip, Loop };

// The triangle list of an index sequence. Triangles of a strip keep the winding of its first one. Indices that do not
// fill a last triangle are dropped, as GPUs do; so are triangles that name a vertex twice.
std::vector<std::uint32_t> triangleList(std::span<const std::uint32_t> indices, Topology topology);

// Calls `change` with each array of attributes that the mesh has.
template <typename Change>
void forEachAttribute(Mesh& mesh, Change change) {
  change(mesh.positions);
  if (!mesh.normals.empty()) change(mesh.normals);
  if (!mesh.tangents.empty()) change(mesh.tangents);
  if (!mesh.texCoords0.empty()) change(mesh.texCoords0);
  if (!mesh.texCoords1.empty()) change(mesh.texCoords1);
  if (!mesh.colors.empty()) change(mesh.colors);
}

// What follows is for meshes of triangles.

// The list of lines of an index sequence, likewise.
std::vector<std::uint32_t> lineList(std::span<const std::uint32_t> indices, LineTopology topology);

// Removes the triangles that have no area, in place. Every index is below vertexCount().
void dropDegenerateTriangles(Mesh& mesh);

// Removes the vertices that no triangle uses.
void dropUnusedVertices(Mesh& mesh);

// Gives each triangle three vertices of its own.
void separateTriangles(Mesh& mesh);

// The same, with the normal of its plane. A mesh without normals is flat as it is: this is for tangents that need them.
void makeFlatNormals(Mesh& mesh);

// Normals that are the mean of the planes around each vertex, weighted by area.
void makeSmoothNormals(Mesh& mesh);

// The normal of each corner is the mean, weighted by area, of the triangles that have a corner at the same place and
// are inclined to its own by less than `crease`, in radians. Vertices whose corners then differ are split. The mesh has
// no triangle without area. `ownPlaces`: no two vertices are at the same place.
void makeCreasedNormals(Mesh& mesh, float crease, bool ownPlaces = false);

// Turns the triangles whose plane faces away from their vertices' normals.
void turnTrianglesToNormals(Mesh& mesh);

// Gives the vertices these normals, scaled to unit length. One that is zero or not finite becomes the mean normal of
// its triangles.
void setRepairedNormals(Mesh& mesh, std::vector<glm::vec3> normals);

// Tangents along growing u of a texture slot, orthogonal to the normals, as the mean over the triangles around each
// vertex. Where vertices are shared between mirrored and unmirrored triangles they are split. Method: Lengyel,
// "Foundations of Game Engine Development" vol. 2, section 7.5.
void makeTangents(Mesh& mesh, const TextureSlot& slot);

// Gives the vertices, which have normals, these tangents, made unit length and orthogonal to the normals, and their w
// +1 or -1. One that cannot be used is replaced by any direction orthogonal to the normal.
void setRepairedTangents(Mesh& mesh, std::span<const glm::vec4> tangents);

// Throws LoadError where a place in the world is beyond what 32-bit floats can draw.
void requireReach(const glm::dvec3& place);

// Throws LoadError where a scene holds no triangle, line or point, or reaches beyond what 32-bit floats can draw.
void requireDrawable(const Scene& scene);

} // namespace vitrail::tool
