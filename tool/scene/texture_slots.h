// All texture slots of a material, for code that treats them alike.
#pragma once

#include "scene.h"

namespace vitrail::tool {

// Calls `visit` with what each slot is for, in words, and the slot of a Material or const Material.
template <class AnyMaterial, class Visit>
void forEachSlot(AnyMaterial& material, Visit visit) {
  visit("base colour", material.baseColorTexture);
  visit("metallic-roughness", material.metallicRoughnessTexture);
  visit("normal", material.normalTexture);
  visit("occlusion", material.occlusionTexture);
  visit("emissive", material.emissiveTexture);
  visit("transmission", material.transmissionTexture);
  visit("thickness", material.thicknessTexture);
  visit("specular", material.specularTexture);
  visit("specular colour", material.specularColorTexture);
  visit("clearcoat", material.clearcoatTexture);
  visit("clearcoat roughness", material.clearcoatRoughnessTexture);
  visit("sheen colour", material.sheenColorTexture);
  visit("sheen roughness", material.sheenRoughnessTexture);
  visit("anisotropy", material.anisotropyTexture);
  visit("iridescence", material.iridescenceTexture);
  visit("iridescence thickness", material.iridescenceThicknessTexture);
}

} // namespace vitrail::tool
