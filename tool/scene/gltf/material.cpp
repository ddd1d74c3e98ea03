// Turns glTF's materials, textures, samplers and images into those of scene.h.
#include "material.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "../image_decode.h"
#include "../load.h"
#include "../message.h"
#include "material_extensions.h"
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

// Renames the sets of texture coordinates that the slots use to 0 and 1. Those of further sets are left out.
void renameTexCoordSets(GltfMaterial& result, const std::string& where, Scene& scene) {
  Material& material = result.material;
  const std::array slots{
      &material.baseColorTexture,           &material.metallicRoughnessTexture,  &material.normalTexture,
      &material.occlusionTexture,           &material.emissiveTexture,           &material.transmissionTexture,
      &material.thicknessTexture,           &material.specularTexture,           &material.specularColorTexture,
      &material.clearcoatTexture,           &material.clearcoatRoughnessTexture, &material.sheenColorTexture,
      &material.sheenRoughnessTexture,      &material.anisotropyTexture,         &material.iridescenceTexture,
      &material.iridescenceThicknessTexture};
  std::vector<std::uint32_t> sets;
  for (TextureSlot* slot : slots) {
    if (slot->image < 0 || std::ranges::find(sets, slot->texCoord) != sets.end()) continue;
    if (sets.size() < 2) {
      sets.push_back(slot->texCoord);
      continue;
    }
    warn(scene,
         fmt::format("{}: a texture with TEXCOORD_{} is left out: at most 2 sets of texture coordinates can be drawn",
                     where, slot->texCoord));
    slot->image = -1;
  }
  std::ranges::sort(sets);
  if (sets.empty() || sets.back() < 2) return;
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

std::int32_t GltfMaterialReader::decode(std::size_t index) {
  const GltfImageSource& source = document_.images[index];
  std::vector<std::byte> outside;
  if (source.bufferView && !source.uri.empty()) throw LoadError("has both of uri and bufferView");
  if (!source.bufferView && source.uri.empty()) throw LoadError("has neither uri nor bufferView");
  if (!source.bufferView) outside = readUri(source.uri, document_.base);
  const bool isFile = !source.bufferView && !source.uri.starts_with("data:");
  try {
    Image image = decodeImage(source.bufferView ? bufferViewBytes(document_, *source.bufferView)
                                                : std::span<const std::byte>(outside));
    pixels_ += std::uint64_t{image.width} * image.height;
    if (pixels_ > mostPixels) throw LoadError("makes the images of this file larger than 4 GiB together");
    scene_.images.push_back(std::move(image));
  } catch (const LoadError& error) {
    if (!isFile) throw;
    throw LoadError(fmt::format("{}: {}", oneLine(source.uri), error.what()));
  }
  return static_cast<std::int32_t>(scene_.images.size() - 1);
}

const GltfMaterialReader::DecodedImage& GltfMaterialReader::image(std::size_t index) {
  const std::string& uri = document_.images[index].uri;
  if (!uri.empty() && !uri.starts_with("data:")) index = files_.emplace(uri, index).first->second;
  const auto known = decoded_.find(index);
  if (known != decoded_.end()) return known->second;
  DecodedImage result;
  try {
    result.image = decode(index);
  } catch (const LoadError& error) {
    result.problem = fmt::format("{}: {}", objectName("image", index, document_.images[index].name), error.what());
  }
  return decoded_.emplace(index, std::move(result)).first->second;
}

// The first of a texture's images that can be read; -1, with a warning, where there is none.
std::int32_t GltfMaterialReader::imageOf(std::size_t index) {
  const tinygltf::Texture& texture = document_.model.textures[index];
  std::vector<std::pair<int, std::string>> sources; // with what the warning begins with
  for (const char* name : {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"}) {
    const auto extension = texture.extensions.find(name);
    if (extension != texture.extensions.end() && extension->second.Has("source"))
      sources.emplace_back(extension->second.Get("source").GetNumberAsInt(), fmt::format("{}: ", name));
  }
  if (texture.source >= 0) sources.emplace_back(texture.source, "");
  std::string problem;
  for (const auto& [source, extension] : sources) {
    const DecodedImage& found = image(static_cast<std::size_t>(source));
    if (found.image >= 0) return found.image;
    if (problem.empty()) problem = extension + found.problem; // of the best image that the file has
  }
  if (sources.empty()) problem = fmt::format("{}: has no image", objectName("texture", index, texture.name));
  warn(scene_, fmt::format("{}; the material is drawn without it", problem));
  return -1;
}

template <typename TextureInfo>
TextureSlot GltfMaterialReader::slot(const TextureInfo& info, const std::string& /*where*/) {
  TextureSlot slot;
  if (info.index < 0) return slot;
  const auto index = static_cast<std::size_t>(info.index);
  const tinygltf::Texture& texture = document_.model.textures[index];
  slot.image = imageOf(index);
  if (slot.image < 0) return {};
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
  for (int c = 0; c < 3; ++c) material.emissive[c] = clampedFactor(source.emissiveFactor[static_cast<std::size_t>(c)]);
  const auto texture = [&](const tinygltf::Value& info) { return slot(textureInfo(info), where); };
  readMaterialExtensions(source, texture, material, scene_);
  renameTexCoordSets(result, where, scene_);
  // The factor alone would make the whole surface shine.
  if (source.emissiveTexture.index >= 0 && material.emissiveTexture.image < 0) material.emissive = glm::vec3(0.0F);
  return result;
}

} // namespace vitrail::tool
