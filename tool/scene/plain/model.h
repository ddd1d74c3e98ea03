// What the readers of OBJ, PLY and STL share. These formats state no colour space: their colours are made to be shown
// as they are, so they are taken as sRGB and made linear. Surfaces are double-sided, since winding is not reliable in
// such files; where a file has vertex normals, its triangles are turned to agree with them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "../scene.h"
#include "../srgb.h"

namespace vitrail::tool {

// The material of a file without any: not metallic, half rough, a light grey of 0.8, or white where vertices or a
// texture bring the colour.
Material plainMaterial(bool colored);

enum class NormalsFrom {
  None,          // flat
  File,          // they are there
  SharedCorners, // smooth where triangles share a vertex
  Places,        // smooth where triangles meet at less than 45 degrees
  OwnPlaces      // the same, of a mesh no two vertices of which are at the same place
};

// Makes the mesh keep scene.h's promises and adds it to the scene with its material, at the origin. Blends the material
// where vertices or its base colour texture are translucent. A mesh without area adds nothing.
// `given`: the normals of NormalsFrom::File, one a vertex.
void addPlainMesh(Scene& scene, Mesh mesh, NormalsFrom normals, Material material, std::vector<glm::vec3> given = {});

// Adds a mesh of lines or points, which are not lit, likewise. One without any adds nothing.
void addUnlitMesh(Scene& scene, Mesh mesh, Material material);

// Reads textures beside a model, each once. One that is missing or damaged gives no texture, and so the plain colour,
// and a warning: such files are often passed on without their textures.
class TextureFiles {
 public:
  explicit TextureFiles(std::filesystem::path base) : base_(std::move(base)) {}
  TextureSlot read(Scene& scene, const std::string& name);

 private:
  std::filesystem::path base_;
  std::map<std::string, std::int32_t> images_;
};

} // namespace vitrail::tool
