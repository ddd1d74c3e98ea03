// Turns glTF's materials, textures, samplers and images into those of scene.h.
#include "material.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "../image_decode.h"
#include "../load.h"
#include "../message.h"
#include "uri.h"

namespace vitrail::tool {
namespace {

// All images of a file together: 4 GiB once they are decoded.
constexpr std::uint64_t mostPixels = std::uint64_t{1} << 30U;

float clampedFactor(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

glm::vec2 vectorOf(const tinygltf::Value& object, const char* key, glm::vec2 value) {
  if (!object.Has(key)) return value;
  const tinygltf::Value& array = object.Get(key);
  return {static_cast<float>(array.Get(0).GetNumberAsDouble()), static_cast<float>(array.Get(1).GetNumberAsDouble())};
}

// KHR_texture_transform: translation * rotation * scale, where a positive rotation turns counter-clockwise in a picture
// whose v grows downwards.
glm::mat3 textureTransform(const tinygltf::Value& extension) {
  const glm::vec2 offset = vectorOf(extension, "offset", glm::vec2(0.0F));
  const glm::vec2 scale = vectorOf(extension, "scale", glm::vec2(1.0F));
  const double rotation = extension.Has("rotation") ? extension.Get("rotation").GetNumberAsDouble() : 0.0;
  const auto c = static_cast<float>(std::cos(rotation));
  const auto s = static_cast<float>(std::sin(rotation));
  const glm::mat3 translate(1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, offset.x, offset.y, 1.0F);
  const glm::mat3 rotate(c, -s, 0.0F, s, c, 0.0F, 0.0F, 0.0F, 1.0F);
  const glm::mat3 stretch(scale.x, 0.0F, 0.0F, 0.0F, scale.y, 0.0F, 0.0F, 0.0F, 1.0F);
  return translate * rotate * stretch;
}

// A texture of an extension, which the library leaves as plain JSON.
tinygltf::TextureInfo textureInfo(const tinygltf::Value& object) {
  tinygltf::TextureInfo info;
  info.index = object.Get("index").GetNumberAsInt();
  if (object.Has("texCoord")) info.texCoord = object.Get("texCoord").GetNumberAsInt();
  if (object.Has("extensions")) info.extensions = object.Get("extensions").Get<tinygltf::Value::Object>();
  return info;
}

Wrap wrapOf(int value, const std::string& where) {
  switch (value) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::Repeat;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::MirroredRepeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::ClampToEdge;
    default:
      throw LoadError(fmt::format("{}: {} is not a wrapping mode", where, value));
  }
}

AlphaMode alphaModeOf(const std::string& text, const std::string& where) {
  if (text.empty() || text == "OPAQUE") return AlphaMode::Opaque;
  if (text == "MASK") return AlphaMode::Mask;
  if (text == "BLEND") return AlphaMode::Blend;
  throw LoadError(fmt::format("{}: alphaMode is \"{}\", none of OPAQUE, MASK and BLEND", where, oneLine(text)));
}

// Renames the sets of texture coordinates that the slots use to 0 and 1.
void renameTexCoordSets(GltfMaterial& result, const std::string& where) {
  Material& material = result.material;
  const std::array slots{&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture,
                         &material.occlusionTexture, &material.emissiveTexture,          &material.transmissionTexture,
                         &material.thicknessTexture};
  std::vector<std::uint32_t> sets;
  for (const TextureSlot* slot : slots)
    if (slot->image >= 0 && std::ranges::find(sets, slot->texCoord) == sets.end()) sets.push_back(slot->texCoord);
  std::ranges::sort(sets);
  if (sets.empty() || sets.back() < 2) return;
  if (sets.size() > 2)
    throw LoadError(
        fmt::format("{}: uses {} sets of texture coordinates, but at most 2 can be drawn", where, sets.size()));
  for (std::size_t i = 0; i < sets.size(); ++i) result.texCoordSets[i] = sets[i];
  for (TextureSlot* slot : slots) slot->texCoord = sets.size() == 2 && slot->texCoord == sets[1] ? 1 : 0;
}

} // namespace

Sampler GltfMaterialReader::sampler(std::size_t index) const {
  const tinygltf::Sampler& source = document_.model.samplers[index];
  const std::string where = objectName("sampler", index, source.name);
  Sampler sampler;
  sampler.wrapU = wrapOf(source.wrapS, where + ": wrapS");
  sampler.wrapV = wrapOf(source.wrapT, where + ": wrapT");
  switch (source.magFilter) {
    case -1:
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
      break;
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
      sampler.magLinear = false;
      break;
    default:
      throw LoadError(fmt::format("{}: magFilter: {} is not a filter", where, source.magFilter));
  }
  const int filter = source.minFilter;
  switch (filter) {
    case -1:
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
      break;
    default:
      throw LoadError(fmt::format("{}: minFilter: {} is not a filter", where, filter));
  }
  sampler.mipmaps = filter != TINYGLTF_TEXTURE_FILTER_NEAREST && filter != TINYGLTF_TEXTURE_FILTER_LINEAR;
  sampler.minLinear = filter != TINYGLTF_TEXTURE_FILTER_NEAREST &&
                      filter != TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST &&
                      filter != TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
  sampler.mipLinear = filter != TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST &&
                      filter != TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST;
  return sampler;
}

std::int32_t GltfMaterialReader::image(std::size_t index) {
  const auto known = decoded_.find(index);
  if (known != decoded_.end()) return known->second;
  const GltfImageSource& source = document_.images[index];
  const std::string where = objectName("image", index, source.name);
  try {
    std::vector<std::byte> outside;
    if (!source.bufferView) outside = readUri(source.uri, document_.base);
    const std::span<const std::byte> file =
        source.bufferView ? bufferViewBytes(document_, *source.bufferView) : outside;
    if (!isPngOrJpeg(file)) throw LoadError("is neither PNG nor JPEG");
    Image image = decodeImage(file);
    pixels_ += std::uint64_t{image.width} * image.height;
    if (pixels_ > mostPixels) throw LoadError("makes the images of this file larger than 4 GiB together");
    scene_.images.push_back(std::move(image));
  } catch (const LoadError& error) {
    throw LoadError(fmt::format("{}: {}", where, error.what()));
  }
  const auto result = static_cast<std::int32_t>(scene_.images.size() - 1);
  decoded_.emplace(index, result);
  return result;
}

template <typename TextureInfo>
TextureSlot GltfMaterialReader::slot(const TextureInfo& info, const std::string& where) {
  TextureSlot slot;
  if (info.index < 0) return slot;
  const auto index = static_cast<std::size_t>(info.index);
  const tinygltf::Texture& texture = document_.model.textures[index];
  if (texture.source < 0)
    throw LoadError(
        fmt::format("{}: {} has no image that can be read", where, objectName("texture", index, texture.name)));
  slot.image = image(static_cast<std::size_t>(texture.source));
  if (texture.sampler >= 0) slot.sampler = sampler(static_cast<std::size_t>(texture.sampler));
  slot.texCoord = static_cast<std::uint32_t>(info.texCoord);
  const auto transform = info.extensions.find("KHR_texture_transform");
  if (transform != info.extensions.end()) {
    slot.transform = textureTransform(transform->second);
    if (transform->second.Has("texCoord"))
      slot.texCoord = static_cast<std::uint32_t>(transform->second.Get("texCoord").GetNumberAsInt());
  }
  return slot;
}

void GltfMaterialReader::readTransmission(Material& material, const tinygltf::Value& extension,
                                          const std::string& where) {
  if (extension.Has("transmissionFactor"))
    material.transmission = clampedFactor(extension.Get("transmissionFactor").GetNumberAsDouble());
  if (extension.Has("transmissionTexture"))
    material.transmissionTexture = slot(textureInfo(extension.Get("transmissionTexture")), where);
}

// What is behind a surface that lets nothing through is not seen, so it is not read.
void GltfMaterialReader::readVolume(Material& material, const tinygltf::Value& extension, const std::string& where) {
  if (!(material.transmission > 0.0F)) return;
  const auto number = [&](const char* key) {
    return extension.Has(key) ? static_cast<float>(std::max(extension.Get(key).GetNumberAsDouble(), 0.0)) : 0.0F;
  };
  material.thickness = number("thicknessFactor");
  material.attenuationDistance = number("attenuationDistance");
  if (extension.Has("thicknessTexture"))
    material.thicknessTexture = slot(textureInfo(extension.Get("thicknessTexture")), where);
  if (!extension.Has("attenuationColor")) return;
  const tinygltf::Value& color = extension.Get("attenuationColor");
  for (int c = 0; c < 3; ++c) material.attenuationColor[c] = clampedFactor(color.Get(c).GetNumberAsDouble());
}

GltfMaterial GltfMaterialReader::read(std::size_t index) {
  const tinygltf::Material& source = document_.model.materials[index];
  const std::string where = objectName("material", index, source.name);
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  GltfMaterial result;
  Material& material = result.material;
  material.name = source.name;
  material.alphaMode = alphaModeOf(source.alphaMode, where);
  material.alphaCutoff = static_cast<float>(std::max(source.alphaCutoff, 0.0));
  material.doubleSided = source.doubleSided;
  for (int c = 0; c < 4; ++c) material.baseColor[c] = clampedFactor(pbr.baseColorFactor[static_cast<std::size_t>(c)]);
  material.metallic = clampedFactor(pbr.metallicFactor);
  material.roughness = clampedFactor(pbr.roughnessFactor);
  material.baseColorTexture = slot(pbr.baseColorTexture, where);

  const auto unlit = source.extensions.find("KHR_materials_unlit");
  material.unlit = unlit != source.extensions.end();
  material.metallicRoughnessTexture = slot(pbr.metallicRoughnessTexture, where);
  material.normalTexture = slot(source.normalTexture, where);
  material.normalScale = static_cast<float>(source.normalTexture.scale);
  material.occlusionTexture = slot(source.occlusionTexture, where);
  material.occlusionStrength = clampedFactor(source.occlusionTexture.strength);
  material.emissiveTexture = slot(source.emissiveTexture, where);
  double strength = 1.0;
  const auto emissive = source.extensions.find("KHR_materials_emissive_strength");
  if (emissive != source.extensions.end() && emissive->second.Has("emissiveStrength"))
    strength = std::max(emissive->second.Get("emissiveStrength").GetNumberAsDouble(), 0.0);
  for (int c = 0; c < 3; ++c)
    // The product of two numbers that a float holds may be one that it does not.
    material.emissive[c] =
        static_cast<float>(std::min(clampedFactor(source.emissiveFactor[static_cast<std::size_t>(c)]) * strength,
                                    static_cast<double>(std::numeric_limits<float>::max())));
  const auto transmission = source.extensions.find("KHR_materials_transmission");
  if (transmission != source.extensions.end()) readTransmission(material, transmission->second, where);
  const auto volume = source.extensions.find("KHR_materials_volume");
  if (volume != source.extensions.end()) readVolume(material, volume->second, where);
  renameTexCoordSets(result, where);
  return result;
}

} // namespace vitrail::tool
