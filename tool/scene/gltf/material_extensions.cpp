// One function an extension. What docs/shading.md draws is read; what it does not is warned of.
#include "material_extensions.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "../message.h"

namespace vitrail::tool {
namespace {

constexpr double kLargest = std::numeric_limits<float>::max();

// The JSON of one extension of a material.
class Extension {
 public:
  Extension(const tinygltf::Material& material, const char* name,
            const std::function<TextureSlot(const tinygltf::Value&)>& texture)
      : texture_(texture) {
    const auto found = material.extensions.find(name);
    if (found != material.extensions.end()) json_ = &found->second;
  }

  explicit operator bool() const { return json_ != nullptr; }
  [[nodiscard]] bool has(const char* key) const { return json_->Has(key); }

  // `value` stays where the file says nothing.
  void read(const char* key, float& value, double low, double high) const {
    if (has(key)) value = static_cast<float>(std::clamp(json_->Get(key).GetNumberAsDouble(), low, high));
  }
  void read(const char* key, glm::vec3& color, double high) const {
    if (!has(key)) return;
    for (int c = 0; c < 3; ++c)
      color[c] = static_cast<float>(std::clamp(json_->Get(key).Get(c).GetNumberAsDouble(), 0.0, high));
  }
  void read(const char* key, TextureSlot& slot) const {
    if (has(key)) slot = texture_(json_->Get(key));
  }
  [[nodiscard]] glm::vec4 color(const char* key) const {
    glm::vec4 color(1.0F);
    if (!has(key)) return color;
    for (int c = 0; c < 4; ++c)
      color[c] = static_cast<float>(std::clamp(json_->Get(key).Get(c).GetNumberAsDouble(), 0.0, 1.0));
    return color;
  }

 private:
  const tinygltf::Value* json_ = nullptr;
  const std::function<TextureSlot(const tinygltf::Value&)>& texture_;
};

void readEmissiveStrength(const Extension& extension, Material& material) {
  float strength = 1.0F;
  extension.read("emissiveStrength", strength, 0.0, kLargest);
  // The product of two numbers that a float holds may be one that it does not.
  for (int c = 0; c < 3; ++c)
    material.emissive[c] = static_cast<float>(std::min(double{material.emissive[c]} * double{strength}, kLargest));
}

void readTransmission(const Extension& extension, Material& material) {
  extension.read("transmissionFactor", material.transmission, 0.0, 1.0);
  extension.read("transmissionTexture", material.transmissionTexture);
}

void readVolume(const Extension& extension, Material& material) {
  extension.read("thicknessFactor", material.thickness, 0.0, kLargest);
  extension.read("thicknessTexture", material.thicknessTexture);
  extension.read("attenuationDistance", material.attenuationDistance, 0.0, kLargest);
  extension.read("attenuationColor", material.attenuationColor, 1.0);
}

// 0 stands for infinity; what else is below 1 is no index of a solid.
void readIor(const Extension& extension, Material& material) {
  extension.read("ior", material.ior, 0.0, 1e6);
  if (material.ior > 0.0F) material.ior = std::max(material.ior, 1.0F);
}

void readSpecular(const Extension& extension, Material& material) {
  extension.read("specularFactor", material.specular, 0.0, 1.0);
  extension.read("specularTexture", material.specularTexture);
  extension.read("specularColorFactor", material.specularColor, 1e6);
  extension.read("specularColorTexture", material.specularColorTexture);
}

void readSpecularGlossiness(const Extension& extension, Material& material) {
  material.specularGlossiness = true;
  material.baseColor = extension.color("diffuseFactor");
  material.baseColorTexture = TextureSlot{};
  extension.read("diffuseTexture", material.baseColorTexture);
  material.specularColor = glm::vec3(1.0F);
  extension.read("specularFactor", material.specularColor, 1.0);
  float glossiness = 1.0F;
  extension.read("glossinessFactor", glossiness, 0.0, 1.0);
  material.roughness = 1.0F - glossiness;
  material.metallic = 0.0F;
  material.metallicRoughnessTexture = TextureSlot{};
  extension.read("specularGlossinessTexture", material.metallicRoughnessTexture);
}

void readClearcoat(const Extension& extension, Material& material) {
  extension.read("clearcoatFactor", material.clearcoat, 0.0, 1.0);
  extension.read("clearcoatTexture", material.clearcoatTexture);
  extension.read("clearcoatRoughnessFactor", material.clearcoatRoughness, 0.0, 1.0);
  extension.read("clearcoatRoughnessTexture", material.clearcoatRoughnessTexture);
}

void readSheen(const Extension& extension, Material& material) {
  extension.read("sheenColorFactor", material.sheenColor, 1.0);
  extension.read("sheenColorTexture", material.sheenColorTexture);
  extension.read("sheenRoughnessFactor", material.sheenRoughness, 0.0, 1.0);
  extension.read("sheenRoughnessTexture", material.sheenRoughnessTexture);
}

void readAnisotropy(const Extension& extension, Material& material) {
  extension.read("anisotropyStrength", material.anisotropy, 0.0, 1.0);
  extension.read("anisotropyRotation", material.anisotropyRotation, -kLargest, kLargest);
  extension.read("anisotropyTexture", material.anisotropyTexture);
}

void readIridescence(const Extension& extension, Material& material) {
  extension.read("iridescenceFactor", material.iridescence, 0.0, 1.0);
  extension.read("iridescenceTexture", material.iridescenceTexture);
  extension.read("iridescenceIor", material.iridescenceIor, 1.0, 1e3);
  extension.read("iridescenceThicknessMinimum", material.iridescenceThickness.x, 0.0, 1e5);
  extension.read("iridescenceThicknessMaximum", material.iridescenceThickness.y, 0.0, 1e5);
  extension.read("iridescenceThicknessTexture", material.iridescenceThicknessTexture);
}

void readDiffuseTransmission(const Extension& extension, Material& material) {
  extension.read("diffuseTransmissionFactor", material.diffuseTransmission, 0.0, 1.0);
  extension.read("diffuseTransmissionColorFactor", material.diffuseTransmissionColor, 1.0);
}

// The textures of extensions for which no slot is left.
void warnOfTextures(const Extension& clearcoat, const Extension& diffuseTransmission, Scene& scene) {
  if (clearcoat && clearcoat.has("clearcoatNormalTexture"))
    warn(scene, "the clearcoatNormalTexture of materials is not drawn: coats are smooth");
  for (const char* key : {"diffuseTransmissionTexture", "diffuseTransmissionColorTexture"}) {
    if (diffuseTransmission && diffuseTransmission.has(key))
      warn(scene, fmt::format("the {} of materials is not drawn: light comes through the same everywhere", key));
  }
}

} // namespace

void readMaterialExtensions(const tinygltf::Material& source,
                            const std::function<TextureSlot(const tinygltf::Value&)>& texture, Material& material,
                            Scene& scene) {
  using Read = void (*)(const Extension&, Material&);
  constexpr std::pair<const char*, Read> kExtensions[] = {
      {"KHR_materials_emissive_strength", readEmissiveStrength},
      {"KHR_materials_transmission", readTransmission},
      {"KHR_materials_volume", readVolume},
      {"KHR_materials_ior", readIor},
      {"KHR_materials_specular", readSpecular},
      {"KHR_materials_pbrSpecularGlossiness", readSpecularGlossiness}, // takes the place of those before it
      {"KHR_materials_clearcoat", readClearcoat},
      {"KHR_materials_sheen", readSheen},
      {"KHR_materials_anisotropy", readAnisotropy},
      {"KHR_materials_iridescence", readIridescence},
      {"KHR_materials_diffuse_transmission", readDiffuseTransmission},
  };
  for (const auto& [name, read] : kExtensions) {
    if (const Extension extension(source, name, texture); extension) read(extension, material);
  }
  warnOfTextures(Extension(source, "KHR_materials_clearcoat", texture),
                 Extension(source, "KHR_materials_diffuse_transmission", texture), scene);
  if (material.diffuseTransmission > 0.0F && material.thickness > 0.0F && material.attenuationDistance > 0.0F)
    warn(scene,
         "KHR_materials_volume with KHR_materials_diffuse_transmission: the light that comes through is not "
         "attenuated");
}

} // namespace vitrail::tool
