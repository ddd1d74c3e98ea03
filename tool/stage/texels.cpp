#include "texels.h"

#include <array>
#include <map>

#include <glm/gtc/packing.hpp>

#include "../scene/srgb.h"
#include "material_data.h"

namespace vitrail::tool {

bool isFilled(const Scene& scene, const TextureSlot& slot) {
  if (slot.image < 0) return false;
  const Image& image = scene.images.at(static_cast<std::size_t>(slot.image));
  return image.width > 0 && image.height > 0;
}

std::uint32_t filledSlots(const Scene& scene, const Material& material) {
  const auto slots = slotsOf(material);
  std::uint32_t filled = 0;
  for (std::uint32_t i = 0; i < shaders::SLOT_COUNT; ++i) {
    if (isFilled(scene, *slots.at(i))) filled |= 1U << i;
  }
  return filled;
}

bool isTranslucent(const Image& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] != 255) return true;
  }
  return false;
}

Texels texelsOf(const Material& material, std::uint32_t slot, bool premultiplied) {
  switch (slot) {
    case shaders::SLOT_BASE_COLOR:
      return premultiplied ? Texels::Premultiplied : Texels::Srgb;
    case shaders::SLOT_METALLIC_ROUGHNESS:
      return material.specularGlossiness ? Texels::Srgb : Texels::Linear;
    case shaders::SLOT_EMISSIVE:
    case shaders::SLOT_SPECULAR_COLOR:
    case shaders::SLOT_SHEEN_COLOR:
      return Texels::Srgb;
    default:
      return Texels::Linear;
  }
}

std::vector<std::uint32_t> usedMaterials(const Scene& scene) {
  std::set<std::uint32_t> used;
  for (const Draw& draw : scene.draws) used.insert(draw.material);
  return {used.begin(), used.end()};
}

std::set<std::uint32_t> premultipliedMaterials(const Scene& scene, const std::vector<std::uint32_t>& materials) {
  std::set<std::uint32_t> result;
  std::map<std::int32_t, bool> translucent; // by image
  for (const std::uint32_t material : materials) {
    const Material& source = scene.materials.at(material);
    const TextureSlot& base = source.baseColorTexture;
    if (source.alphaMode == AlphaMode::Opaque || !isFilled(scene, base)) continue;
    const auto [known, isNew] = translucent.try_emplace(base.image, false);
    if (isNew) known->second = isTranslucent(scene.images.at(static_cast<std::size_t>(base.image)));
    if (known->second) result.insert(material);
  }
  return result;
}

std::vector<std::uint16_t> premultiply(const Image& image) {
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    linear.at(i) = linearFromSrgb(glm::vec3(static_cast<float>(i) / 255.0F)).r;
  }
  std::vector<std::uint16_t> products(std::size_t{256} * 256); // by alpha and colour
  for (std::size_t i = 0; i < products.size(); ++i) {
    products[i] = glm::packHalf1x16(linear.at(i % 256) * (static_cast<float>(i / 256) / 255.0F));
  }
  std::vector<std::uint16_t> texels(image.rgba.size());
  for (std::size_t i = 0; i + 3 < texels.size(); i += 4) {
    const std::size_t alpha = image.rgba[i + 3];
    for (std::size_t c = i; c < i + 3; ++c) texels[c] = products[alpha * 256 + image.rgba[c]];
    texels[i + 3] = glm::packHalf1x16(static_cast<float>(alpha) / 255.0F);
  }
  return texels;
}

} // namespace vitrail::tool
