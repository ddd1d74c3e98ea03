// Turns glTF's materials, textures, samplers and images into those of scene.h.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "../scene.h"
#include "document.h"

namespace vitrail::tool {

// Meshes have two sets of texture coordinates. A material that uses sets beyond the first two renames them.
struct GltfMaterial {
  Material material;
  std::array<std::uint32_t, 2> texCoordSets{0, 1}; // which TEXCOORD_n becomes texCoord0 and texCoord1
};

// Converts materials, and decodes each image once, when the first material asks for it.
class GltfMaterialReader {
 public:
  // Both outlive the reader; images are added to the scene.
  GltfMaterialReader(const GltfDocument& document, Scene& scene) : document_(document), scene_(scene) {}

  // Throws LoadError.
  GltfMaterial read(std::size_t material);

 private:
  template <typename TextureInfo>
  TextureSlot slot(const TextureInfo& info, const std::string& where);
  void readTransmission(Material& material, const tinygltf::Value& extension, const std::string& where);
  void readVolume(Material& material, const tinygltf::Value& extension, const std::string& where);
  Sampler sampler(std::size_t index) const;
  std::int32_t image(std::size_t index);

  const GltfDocument& document_;
  Scene& scene_;
  std::unordered_map<std::size_t, std::int32_t> decoded_; // from the file's image to the scene's
  std::uint64_t pixels_ = 0;
};

} // namespace vitrail::tool
