#include "material_data.h"

#include <cmath>

#include "../scene/volume.h"
#include "texels.h"

namespace vitrail::tool {

namespace {

shaders::SlotData makeSlotData(const TextureSlot& slot) {
  const glm::mat3 rows = glm::transpose(slot.transform);
  return {glm::vec4(rows[0], static_cast<float>(slot.texCoord)), glm::vec4(rows[1], 0.0F)};
}

} // namespace

shaders::MaterialData makeMaterialData(const Material& material, std::optional<float> opacity) {
  shaders::MaterialData data{};
  data.baseColor = material.baseColor;
  data.emissive = glm::vec4(material.emissive, 0.0F);
  data.attenuation = glm::vec4(material.thickness * absorption(material), 0.0F);
  data.metallic = material.metallic;
  data.roughness = material.roughness;
  data.normalScale = material.normalScale;
  data.occlusionStrength = material.occlusionStrength;
  data.alphaCutoff = material.alphaCutoff;
  data.alphaFromBase = material.alphaMode == AlphaMode::Blend ? 1.0F : 0.0F;
  data.opacity = opacity.value_or(1.0F);
  data.transmission = material.transmission;
  data.specularColor = glm::vec4(material.specularColor, material.specular);
  data.sheen = glm::vec4(material.sheenColor, material.sheenRoughness);
  data.diffuseTransmission = glm::vec4(material.diffuseTransmissionColor, material.diffuseTransmission);
  data.iridescence = glm::vec4(material.iridescence, material.iridescenceIor, material.iridescenceThickness.x,
                               material.iridescenceThickness.y);
  data.anisotropy = glm::vec4(material.anisotropy, std::cos(material.anisotropyRotation),
                              std::sin(material.anisotropyRotation), 0.0F);
  const float reflected = (material.ior - 1.0F) / (material.ior + 1.0F);
  data.reflectance = reflected * reflected;
  data.clearcoat = material.clearcoat;
  data.clearcoatRoughness = material.clearcoatRoughness;
  const auto slots = slotsOf(material);
  for (std::uint32_t i = 0; i < shaders::SLOT_COUNT; ++i) data.slots[i] = makeSlotData(*slots.at(i));
  return data;
}

std::array<const TextureSlot*, shaders::SLOT_COUNT> slotsOf(const Material& material) {
  std::array<const TextureSlot*, shaders::SLOT_COUNT> slots{};
  slots[shaders::SLOT_BASE_COLOR] = &material.baseColorTexture;
  slots[shaders::SLOT_METALLIC_ROUGHNESS] = &material.metallicRoughnessTexture;
  slots[shaders::SLOT_NORMAL] = &material.normalTexture;
  slots[shaders::SLOT_OCCLUSION] = &material.occlusionTexture;
  slots[shaders::SLOT_EMISSIVE] = &material.emissiveTexture;
  slots[shaders::SLOT_TRANSMISSION] = &material.transmissionTexture;
  slots[shaders::SLOT_SPECULAR] = &material.specularTexture;
  slots[shaders::SLOT_SPECULAR_COLOR] = &material.specularColorTexture;
  slots[shaders::SLOT_CLEARCOAT] = &material.clearcoatTexture;
  slots[shaders::SLOT_CLEARCOAT_ROUGHNESS] = &material.clearcoatRoughnessTexture;
  slots[shaders::SLOT_THICKNESS] = &material.thicknessTexture;
  slots[shaders::SLOT_SHEEN_COLOR] = &material.sheenColorTexture;
  slots[shaders::SLOT_SHEEN_ROUGHNESS] = &material.sheenRoughnessTexture;
  slots[shaders::SLOT_ANISOTROPY] = &material.anisotropyTexture;
  slots[shaders::SLOT_IRIDESCENCE] = &material.iridescenceTexture;
  slots[shaders::SLOT_IRIDESCENCE_THICKNESS] = &material.iridescenceThicknessTexture;
  return slots;
}

namespace {

constexpr std::uint32_t bit(std::uint32_t slot) { return 1U << slot; }

// What a lit material's extensions ask for. The textures of those that are not there are not sampled.
std::uint32_t extensionsOf(const Material& material, std::uint32_t features) {
  const auto need = [&](bool there, std::uint32_t feature, std::uint32_t slots) {
    if (there) features |= feature;
    if (!there) features &= ~slots;
  };
  need(material.transmission > 0.0F, shaders::FEATURE_TRANSMISSION, bit(shaders::SLOT_TRANSMISSION));
  need(absorption(material) != glm::vec3(0.0F), shaders::FEATURE_VOLUME, bit(shaders::SLOT_THICKNESS));
  if (material.specularGlossiness) features |= shaders::FEATURE_SPECULAR_GLOSSINESS;
  need(!material.specularGlossiness &&
           (material.ior != 1.5F || material.specular != 1.0F || material.specularColor != glm::vec3(1.0F) ||
            (features & (bit(shaders::SLOT_SPECULAR) | bit(shaders::SLOT_SPECULAR_COLOR))) != 0),
       shaders::FEATURE_SPECULAR, bit(shaders::SLOT_SPECULAR) | bit(shaders::SLOT_SPECULAR_COLOR));
  need(material.clearcoat > 0.0F, shaders::FEATURE_CLEARCOAT,
       bit(shaders::SLOT_CLEARCOAT) | bit(shaders::SLOT_CLEARCOAT_ROUGHNESS));
  need(material.sheenColor != glm::vec3(0.0F), shaders::FEATURE_SHEEN,
       bit(shaders::SLOT_SHEEN_COLOR) | bit(shaders::SLOT_SHEEN_ROUGHNESS));
  if (material.anisotropy != 0.0F || material.iridescence > 0.0F || material.diffuseTransmission > 0.0F) {
    features |= shaders::FEATURE_RARE;
  }
  need(material.anisotropy != 0.0F, 0, bit(shaders::SLOT_ANISOTROPY));
  need(material.iridescence > 0.0F, 0, bit(shaders::SLOT_IRIDESCENCE) | bit(shaders::SLOT_IRIDESCENCE_THICKNESS));
  return features;
}

} // namespace

std::uint32_t featuresOf(const Scene& scene, const Material& material, const Mesh& mesh, bool premultiplied) {
  std::uint32_t features = filledSlots(scene, material);
  const bool triangles = mesh.primitive == Primitive::Triangles;
  const bool unlit = material.unlit || (!triangles && mesh.normals.empty());
  if (!triangles) features &= ~bit(shaders::SLOT_NORMAL); // they have no surface that tangents could lie in
  if (unlit) {
    features = (features & bit(shaders::SLOT_BASE_COLOR)) | shaders::FEATURE_UNLIT;
  } else {
    features = extensionsOf(material, features);
    if (!scene.lights.empty()) features |= shaders::FEATURE_LIGHTS;
  }
  if (mesh.primitive == Primitive::Lines) features |= shaders::FEATURE_LINES;
  if (mesh.primitive == Primitive::Points) features |= shaders::FEATURE_POINTS;
  if (premultiplied) features |= shaders::FEATURE_PREMULTIPLIED;
  if (material.alphaMode == AlphaMode::Mask) features |= shaders::FEATURE_MASK;
  if (!mesh.colors.empty()) features |= shaders::FEATURE_VERTEX_COLOR;
  if (triangles && mesh.normals.empty() && !unlit) features |= shaders::FEATURE_FLAT;
  const bool transmissive = (features & shaders::FEATURE_TRANSMISSION) != 0;
  if (!transmissive && material.blend == BlendMode::Additive) features |= shaders::FEATURE_ADDITIVE;
  return features;
}

} // namespace vitrail::tool
