// What a PLY file holds, before meshes are made of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "file_bounds.h"
#include "ply_header.h"

namespace vitrail::tool {

// Each array of a group has one element for each of the group's things, or none at all. Colours are linear and
// packed as meshes keep them.
struct PlyData {
  FileBounds bounds; // of the vertices that are finite

  // Vertices. A position that is not finite has a NaN as x.
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<std::uint64_t> colors;
  std::vector<glm::vec2> texCoords; // v grows downwards
  std::size_t notFinite = 0;        // how many positions are not finite
  bool splats = false;              // they are the centres of Gaussian splats
  bool onlyAlpha = false;           // their colours are an alpha and the plain colour

  // Faces.
  std::size_t faceCount = 0;
  std::vector<std::uint32_t> sizes;   // how many corners each face has; empty: 3 each
  std::vector<std::uint32_t> corners; // vertices, of all faces, one after the other
  std::vector<std::uint64_t> faceColors;
  std::vector<std::int32_t> faceTextures; // places among the header's textures
  std::vector<glm::vec2> cornerTexCoords;
  std::vector<std::uint64_t> cornerColors;
  std::size_t oddTexCoords = 0; // faces whose list of texture coordinates does not go with their corners

  // Edges: two vertices each.
  std::vector<std::uint32_t> edges;
  std::vector<std::uint64_t> edgeColors;

  std::vector<std::string> warnings; // what of the file is left out
};

// Reads the body that follows the header; positions are relative to `origin`. Throws LoadError.
PlyData readPlyBody(const PlyHeader& header, std::span<const std::byte> body, const glm::dvec3& origin);

} // namespace vitrail::tool
