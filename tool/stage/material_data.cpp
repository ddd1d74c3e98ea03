#include "material_data.h"

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
  return data;
}

std::uint32_t featuresOf(const Scene& scene, const Material& material, const Mesh& mesh) {
  std::uint32_t features = MaterialTextures::filledSlots(scene, material);
  const bool triangles = mesh.primitive == Primitive::Triangles;
  const bool unlit = material.unlit || (!triangles && mesh.normals.empty());
  if (!triangles) features &= ~(1U << shaders::SLOT_NORMAL); // they have no surface that tangents could lie in
  if (mesh.primitive == Primitive::Lines) features |= shaders::FEATURE_LINES;
  if (mesh.primitive == Primitive::Points) features |= shaders::FEATURE_POINTS;
  constexpr std::uint32_t kept = 1U << shaders::SLOT_BASE_COLOR | shaders::FEATURE_LINES | shaders::FEATURE_POINTS;
  if (unlit) features = (features & kept) | shaders::FEATURE_UNLIT;
  if (material.alphaMode == AlphaMode::Mask) features |= shaders::FEATURE_MASK;
  if (!mesh.colors.empty()) features |= shaders::FEATURE_VERTEX_COLOR;
  if (triangles && mesh.normals.empty() && !unlit) features |= shaders::FEATURE_FLAT;
  const bool transmissive = material.transmission > 0.0F && !unlit;
  if (transmissive) features |= shaders::FEATURE_TRANSMISSION;
  if (!transmissive) features &= ~(1U << shaders::SLOT_TRANSMISSION);
  if (!transmissive && material.blend == BlendMode::Additive) features |= shaders::FEATURE_ADDITIVE;
  return features;
}

} // namespace vitrail::tool
