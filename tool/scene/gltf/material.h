// Turns glTF's materials, textures, samplers and images into those of scene.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
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
  Sampler sampler(std::size_t index) const;
  // What became of one image of the file.
  struct DecodedImage {
    std::int32_t image = -1; // of the scene
    std::string problem;     // why there is none
  };
  std::int32_t decode(std::size_t image);
  const DecodedImage& image(std::size_t index);
  std::int32_t imageOf(std::size_t texture);

  const GltfDocument& document_;
  Scene& scene_;
  std::unordered_map<std::size_t, DecodedImage> decoded_;   // by the file's image, good or bad
  std::unordered_map<std::string_view, std::size_t> files_; // the first image of each file's name
  std::uint64_t pixels_ = 0;
};

} // namespace vitrail::tool
