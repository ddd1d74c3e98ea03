// Makes materials out of what the libraries of OBJ files say.
#include "obj_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "../image_decode.h"
#include "../load.h"
#include "../message.h"
#include "../read_file.h"
#include "find_file.h"
#include "model.h"
#include "picture_math.h"

namespace vitrail::tool {
namespace {

// OBJ: (u, v) * scale + offset with v upwards. Here v runs downwards: v = 1 - v'.
glm::mat3 transformOf(const MtlMap& map) {
  glm::mat3 transform(1.0F);
  transform[0][0] = map.scale.x;
  transform[1][1] = map.scale.y;
  transform[2][0] = map.offset.x;
  transform[2][1] = 1.0F - map.scale.y - map.offset.y;
  return transform;
}

TextureSlot slotOf(const MtlMap& map, std::int32_t image) {
  TextureSlot slot;
  slot.image = image;
  slot.transform = transformOf(map);
  if (map.clamp) slot.sampler.wrapU = slot.sampler.wrapV = Wrap::ClampToEdge;
  return slot;
}

bool isBlack(const std::optional<glm::vec3>& color) { return color == glm::vec3(0.0F); }

// What exceeds 1 keeps its hue and strength.
glm::vec3 linearEmission(const glm::vec3& stated) {
  const float most = std::max({stated.r, stated.g, stated.b, 1.0F});
  return linearFromSrgb(stated / most) * most;
}

} // namespace

Material ObjMaterials::make(const MtlMaterial& source, const LoadedLibrary& library, bool colored) {
  source_ = &source;
  folder_ = library.folder;
  const TextureSlot slot = baseColorSlot();
  Material material = plainMaterial(slot.image >= 0 || colored);
  material.name = source.name;
  material.baseColorTexture = slot;
  // Writers that rely on the texture alone leave its factor black.
  if (source.diffuse && !(isBlack(source.diffuse) && slot.image >= 0 && !source.diffuseMap.name.empty()))
    material.baseColor = glm::vec4(linearFromSrgb(*source.diffuse), 1.0F);
  material.baseColor.a = opacityOf(source, library.library);
  // Old versions of Blender state 0 where a picture has the opacity.
  if (material.baseColor.a == 0.0F && !source.opacityMap.name.empty()) material.baseColor.a = 1.0F;
  material.unlit = source.illumination == 0;
  if (source.refraction && *source.refraction > 1.0F && *source.refraction <= 5.0F) material.ior = *source.refraction;
  setRoughness(material);
  setMetallicRoughnessTexture(material);
  setNormalTexture(material);
  setEmission(material);
  setTransmission(material);
  return material;
}

std::optional<std::filesystem::path> ObjMaterials::findPicture(const std::string& name) const {
  if (base_.empty()) return std::nullopt;
  const std::array<std::filesystem::path, 2> folders{folder_, base_};
  if (auto found = findFile(name, folders)) return found;
  const std::string_view bare = beforeComment(name);
  if (bare.size() != name.size())
    if (auto found = findFile(bare, folders)) return found;
  // Some write the options behind the name.
  const std::size_t options = name.find(" -");
  return options == std::string::npos ? std::nullopt : findFile(name.substr(0, options), folders);
}

ObjMaterials::Picture* ObjMaterials::load(const MtlMap& map, std::string_view word) {
  if (map.name.empty()) return nullptr;
  const auto path = findPicture(map.name);
  const std::string key = path ? path->lexically_normal().string() : map.name;
  const auto [place, isNew] = pictures_.try_emplace(key);
  if (!isNew) return place->second ? &*place->second : nullptr;
  try {
    if (!path) throw LoadError(base_.empty() ? "external files are not read here" : "no such file");
    place->second = Picture{decodeImage(readFile(*path)), std::nullopt, key};
    return &*place->second;
  } catch (const LoadError& error) {
    warn(scene_, fmt::format("{} {} of the material \"{}\": {}; it is drawn without", word, oneLine(map.name),
                             oneLine(source_->name), error.what()));
    return nullptr;
  }
}

const Image& ObjMaterials::imageOf(const Picture& picture) const {
  return picture.sceneIndex ? scene_.images[static_cast<std::size_t>(*picture.sceneIndex)] : picture.image;
}

std::int32_t ObjMaterials::addToScene(Picture& picture) {
  if (!picture.sceneIndex) {
    picture.sceneIndex = static_cast<std::int32_t>(scene_.images.size());
    scene_.images.push_back(std::move(picture.image));
  }
  return *picture.sceneIndex;
}

std::int32_t ObjMaterials::addImage(std::string key, Image image) {
  const auto index = static_cast<std::int32_t>(scene_.images.size());
  scene_.images.push_back(std::move(image));
  images_.emplace(std::move(key), index);
  return index;
}

std::optional<std::int32_t> ObjMaterials::known(const std::string& key) const {
  const auto found = images_.find(key);
  return found == images_.end() ? std::nullopt : std::optional(found->second);
}

TextureSlot ObjMaterials::baseColorSlot() {
  const MtlMap& diffuse = source_->diffuseMap;
  const MtlMap& opacity = source_->opacityMap;
  Picture* const colors = load(diffuse, "map_Kd");
  Picture* alpha = load(opacity, "map_d");
  // A picture without alpha that is named for both was not meant to be as opaque as it is bright.
  if (alpha != nullptr && alpha == colors && usedChannel(imageOf(*alpha), opacity.channel) == 'l' &&
      opacity.channel == '\0')
    alpha = nullptr;
  if (colors == nullptr && alpha == nullptr) return {};
  const bool plain = diffuse.base == 0.0F && diffuse.gain == 1.0F;
  const char channel = alpha == nullptr ? '\0' : usedChannel(imageOf(*alpha), opacity.channel);
  if (plain && (alpha == nullptr || (alpha == colors && channel == 'm'))) return slotOf(diffuse, addToScene(*colors));
  const std::string key = fmt::format("{}|{}|{}|{}|{}", colors == nullptr ? "" : colors->key, diffuse.base,
                                      diffuse.gain, alpha == nullptr ? "" : alpha->key, channel);
  std::optional<std::int32_t> image = known(key);
  if (!image) {
    std::optional<Image> changed;
    if (colors != nullptr && !plain) changed = rescaled(imageOf(*colors), diffuse.base, diffuse.gain);
    const Image* const source = changed ? &*changed : colors != nullptr ? &imageOf(*colors) : nullptr;
    image = addImage(key, alpha == nullptr ? *source : withAlpha(source, imageOf(*alpha), channel));
  }
  return slotOf(colors == nullptr ? opacity : diffuse, *image);
}

void ObjMaterials::setRoughness(Material& material) {
  // Blinn and Phong's exponent n stands for about the same highlight as a slope of sqrt(2 / (n + 2)), which is the
  // square of the roughness here.
  const bool shines = source_->specular && !isBlack(source_->specular);
  if (source_->specular && !shines) material.roughness = 1.0F;
  if (shines && source_->shininess && *source_->shininess > 0.0F)
    material.roughness = std::pow(2.0F / (*source_->shininess + 2.0F), 0.25F);
  if (source_->roughness) material.roughness = std::clamp(*source_->roughness, 0.0F, 1.0F);
  if (source_->metallic) material.metallic = std::clamp(*source_->metallic, 0.0F, 1.0F);
  if (source_->sheen) material.sheenColor = glm::vec3(std::clamp(*source_->sheen, 0.0F, 1.0F));
  if (source_->clearcoat) material.clearcoat = std::clamp(*source_->clearcoat, 0.0F, 1.0F);
  if (source_->clearcoatRoughness) material.clearcoatRoughness = std::clamp(*source_->clearcoatRoughness, 0.0F, 1.0F);
}

void ObjMaterials::setMetallicRoughnessTexture(Material& material) {
  Picture* const roughness = load(source_->roughnessMap, "map_Pr");
  Picture* const metallic = load(source_->metallicMap, "map_Pm");
  if (roughness == nullptr && metallic == nullptr) return;
  const auto channelOf = [](const Picture* picture, const MtlMap& map) {
    return picture == nullptr ? '\0' : map.channel == '\0' ? 'l' : map.channel;
  };
  const char roughnessChannel = channelOf(roughness, source_->roughnessMap);
  const char metallicChannel = channelOf(metallic, source_->metallicMap);
  const std::string key = fmt::format("mr|{}|{}|{}|{}", roughness == nullptr ? "" : roughness->key, roughnessChannel,
                                      metallic == nullptr ? "" : metallic->key, metallicChannel);
  std::optional<std::int32_t> image = known(key);
  if (!image)
    image =
        addImage(key, metallicRoughnessImage(roughness == nullptr ? nullptr : &imageOf(*roughness), roughnessChannel,
                                             metallic == nullptr ? nullptr : &imageOf(*metallic), metallicChannel));
  material.metallicRoughnessTexture =
      slotOf(roughness != nullptr ? source_->roughnessMap : source_->metallicMap, *image);
  // The pictures hold the values; numbers beside them are those of programs' defaults.
  if (roughness != nullptr) material.roughness = 1.0F;
  if (metallic != nullptr) material.metallic = 1.0F;
}

void ObjMaterials::setNormalTexture(Material& material) {
  if (Picture* const normals = load(source_->normalMap, "norm")) {
    material.normalTexture = slotOf(source_->normalMap, addToScene(*normals));
    material.normalScale = source_->normalMap.strength;
    return;
  }
  const MtlMap& map = source_->bumpMap;
  Picture* const bumps = load(map, "map_Bump");
  if (bumps == nullptr) return;
  // Blender and others name normal maps so, too.
  if (looksLikeNormals(imageOf(*bumps))) {
    material.normalTexture = slotOf(map, addToScene(*bumps));
    material.normalScale = map.strength;
    return;
  }
  const char channel = map.channel == '\0' ? 'l' : map.channel;
  const std::string key = fmt::format("bump|{}|{}|{}", bumps->key, channel, map.strength);
  std::optional<std::int32_t> image = known(key);
  if (!image) image = addImage(key, normalsFromHeights(imageOf(*bumps), channel, map.strength));
  material.normalTexture = slotOf(map, *image);
}

void ObjMaterials::setEmission(Material& material) {
  if (source_->emissive) material.emissive = linearEmission(glm::max(*source_->emissive, 0.0F));
  Picture* const picture = load(source_->emissiveMap, "map_Ke");
  if (picture == nullptr) return;
  material.emissiveTexture = slotOf(source_->emissiveMap, addToScene(*picture));
  if (material.emissive == glm::vec3(0.0F)) material.emissive = glm::vec3(1.0F);
}

// Light that shines through a filter takes on its colour.
void ObjMaterials::setTransmission(Material& material) const {
  if (!source_->filter || (!source_->dissolve && !source_->transparency)) return;
  const glm::vec3 filter = glm::clamp(*source_->filter, 0.0F, 1.0F);
  const float spread = std::max({filter.r, filter.g, filter.b}) - std::min({filter.r, filter.g, filter.b});
  const float opacity = material.baseColor.a;
  if (spread < 0.02F || opacity >= 1.0F) return;
  material.transmission = 1.0F - opacity;
  material.baseColor = glm::vec4(glm::mix(linearFromSrgb(filter), glm::vec3(material.baseColor), opacity), 1.0F);
}

} // namespace vitrail::tool
