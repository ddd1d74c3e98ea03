#include "material_data.h"

#include "../scene/volume.h"
#include "texture.h"

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
  data.slots[shaders::SLOT_BASE_COLOR] = makeSlotData(material.baseColorTexture);
  data.slots[shaders::SLOT_METALLIC_ROUGHNESS] = makeSlotData(material.metallicRoughnessTexture);
  data.slots[shaders::SLOT_NORMAL] = makeSlotData(material.normalTexture);
  data.slots[shaders::SLOT_OCCLUSION] = makeSlotData(material.occlusionTexture);
  data.slots[shaders::SLOT_EMISSIVE] = makeSlotData(material.emissiveTexture);
  data.slots[shaders::SLOT_TRANSMISSION] = makeSlotData(material.transmissionTexture);
  data.slots[shaders::SLOT_THICKNESS] = makeSlotData(material.thicknessTexture);
  return data;
}

std::uint32_t featuresOf(const Scene& scene, const Material& material, const Mesh& mesh) {
  std::uint32_t features = MaterialTextures::filledSlots(scene, material);
  if (material.unlit) features = (features & 1U << shaders::SLOT_BASE_COLOR) | shaders::FEATURE_UNLIT;
  if (material.alphaMode == AlphaMode::Mask) features |= shaders::FEATURE_MASK;
  if (!mesh.colors.empty()) features |= shaders::FEATURE_VERTEX_COLOR;
  const bool flat = mesh.normals.empty() && mesh.primitive == Primitive::Triangles;
  if (flat && !material.unlit) features |= shaders::FEATURE_FLAT;
  const bool transmissive = material.transmission > 0.0F && !material.unlit;
  if (transmissive) features |= shaders::FEATURE_TRANSMISSION;
  if (!transmissive) features &= ~(1U << shaders::SLOT_TRANSMISSION);
  const bool absorbs = absorption(material) != glm::vec3(0.0F);
  if (absorbs) features |= shaders::FEATURE_VOLUME;
  if (!absorbs) features &= ~(1U << shaders::SLOT_THICKNESS);
  if (!transmissive && material.blend == BlendMode::Additive) features |= shaders::FEATURE_ADDITIVE;
  return features;
}

} // namespace vitrail::tool
