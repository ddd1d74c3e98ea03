// Makes materials out of what the libraries of OBJ files say.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../scene.h"
#include "mtl.h"

namespace vitrail::tool {

// A library's materials and the folder that it lies in.
struct LoadedLibrary {
  MtlLibrary library;
  std::filesystem::path folder;
};

// Makes the materials of a scene and the images that they use. Pictures are looked for beside the library, then beside
// the model in `base`; one that is missing leaves the material without it, and a warning.
class ObjMaterials {
 public:
  ObjMaterials(Scene& scene, std::filesystem::path base) : scene_(scene), base_(std::move(base)) {}

  // `colored`: the vertices bring the colour where the material states none.
  Material make(const MtlMaterial& source, const LoadedLibrary& library, bool colored);

 private:
  struct Picture {
    Image image; // empty once it is an image of the scene
    std::optional<std::int32_t> sceneIndex;
    std::string key; // tells it from others
  };

  // Null where there is no such picture.
  Picture* load(const MtlMap& map, std::string_view word);
  std::optional<std::filesystem::path> findPicture(const std::string& name) const;
  const Image& imageOf(const Picture& picture) const;
  std::int32_t addToScene(Picture& picture);
  std::int32_t addImage(std::string key, Image image);
  std::optional<std::int32_t> known(const std::string& key) const;

  TextureSlot baseColorSlot();
  void setRoughness(Material& material);
  void setMetallicRoughnessTexture(Material& material);
  void setNormalTexture(Material& material);
  void setEmission(Material& material);
  void setTransmission(Material& material) const;

  Scene& scene_;
  std::filesystem::path base_;
  const MtlMaterial* source_ = nullptr; // of the material that is made
  std::filesystem::path folder_;
  std::map<std::string, std::optional<Picture>> pictures_; // by path; none: it could not be read
  std::map<std::string, std::int32_t> images_;             // of the scene, by what they are made of
};

} // namespace vitrail::tool
