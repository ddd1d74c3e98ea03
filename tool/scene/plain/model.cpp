// What the readers of OBJ, PLY and STL share.
#include "model.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "../image_decode.h"
#include "../load.h"
#include "../mesh_build.h"
#include "../message.h"
#include "../read_file.h"
#include "find_file.h"

namespace vitrail::tool {
namespace {

bool isTranslucent(const Mesh& mesh) {
  return std::ranges::any_of(mesh.colors, [](std::uint64_t color) { return unpackColor(color).a < 1.0F; });
}

bool isTranslucent(const Image& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    if (image.rgba[i] != 255) return true;
  return false;
}

// Places the mesh at the origin, and blends its material where anything of it is translucent.
void addDraw(Scene& scene, Mesh mesh, Material material) {
  const std::int32_t image = material.baseColorTexture.image;
  if (material.baseColor.a < 1.0F || isTranslucent(mesh) ||
      (image >= 0 && isTranslucent(scene.images[static_cast<std::size_t>(image)])))
    material.alphaMode = AlphaMode::Blend;
  scene.draws.push_back({static_cast<std::uint32_t>(scene.meshes.size()),
                         static_cast<std::uint32_t>(scene.materials.size()), glm::mat4(1.0F)});
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(std::move(material));
}

} // namespace

Material plainMaterial(bool colored) {
  Material material;
  material.doubleSided = true;
  material.metallic = 0.0F;
  material.roughness = 0.5F;
  if (!colored) material.baseColor = glm::vec4(0.8F, 0.8F, 0.8F, 1.0F);
  return material;
}

void addPlainMesh(Scene& scene, Mesh mesh, NormalsFrom normals, Material material, std::vector<glm::vec3> given) {
  constexpr float crease = 0.7853982F;
  dropDegenerateTriangles(mesh);
  if (mesh.indices.empty()) return;
  if (normals == NormalsFrom::File) setRepairedNormals(mesh, std::move(given));
  dropUnusedVertices(mesh);
  switch (normals) {
    case NormalsFrom::None:
      break;
    case NormalsFrom::File:
      turnTrianglesToNormals(mesh);
      break;
    case NormalsFrom::SharedCorners:
      makeSmoothNormals(mesh);
      break;
    case NormalsFrom::Places:
    case NormalsFrom::OwnPlaces:
      makeCreasedNormals(mesh, crease, normals == NormalsFrom::OwnPlaces);
      break;
  }
  addDraw(scene, std::move(mesh), std::move(material));
}

void addUnlitMesh(Scene& scene, Mesh mesh, Material material) {
  if (!mesh.indices.empty()) addDraw(scene, std::move(mesh), std::move(material));
}

TextureSlot TextureFiles::read(Scene& scene, const std::string& name) {
  TextureSlot slot;
  const auto known = images_.find(name);
  if (known != images_.end()) {
    slot.image = known->second;
    return slot;
  }
  try {
    if (base_.empty()) throw LoadError("external files are not read here");
    const std::optional<std::filesystem::path> path = findFile(name, std::span(&base_, 1));
    if (!path) throw LoadError("no such file");
    Image image = decodeImage(readFile(*path));
    slot.image = static_cast<std::int32_t>(scene.images.size());
    scene.images.push_back(std::move(image));
  } catch (const LoadError& error) {
    warn(scene, fmt::format("the texture {}: {}; surfaces are drawn without it", oneLine(name), error.what()));
  }
  images_.emplace(name, slot.image);
  return slot;
}

} // namespace vitrail::tool
