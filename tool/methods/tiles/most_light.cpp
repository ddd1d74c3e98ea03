#include "most_light.h"

#include <algorithm>

#include "../../stage/surface_shared.h"

namespace vitrail::tool {

namespace {

constexpr float kPi = 3.14159265F;

float largest(const glm::vec3& color) { return std::max({color.r, color.g, color.b}); }

// Of NL * D * Vis: D is at most 1 / (pi a^2), and NL * Vis at most 0.5 / a. A texture can make the roughness smaller.
float lobe(float roughness, bool textured) {
  const float r = textured ? 0.045F : std::clamp(roughness, 0.045F, 1.0F);
  const float a = r * r;
  return 0.5F / (kPi * a * a * a);
}

float mostOf(const Material& material, std::uint32_t features) {
  // Numbers that files give without a bound, and formulas with more cases than are worth it.
  constexpr std::uint32_t kUnbounded = shaders::FEATURE_LIGHTS | shaders::FEATURE_RARE | shaders::FEATURE_VERTEX_COLOR;
  if ((features & kUnbounded) != 0) return shaders::LARGEST_HALF;
  const auto has = [features](std::uint32_t feature) { return (features & feature) != 0; };
  const auto textured = [&has](std::uint32_t slot) { return has(1U << slot); };
  const float base = largest(glm::vec3(material.baseColor));
  if (has(shaders::FEATURE_UNLIT)) return base;
  const float reflected = std::max({1.0F, largest(material.specularColor), base}); // Fresnel's share
  // The light's strength is 2; the hemisphere's is below 0.42, of which all may be reflected in either way.
  const bool glossy = textured(shaders::SLOT_METALLIC_ROUGHNESS);
  float most = 2.0F * (base / kPi + reflected * lobe(material.roughness, glossy)) + 0.42F * (base + reflected) +
               largest(material.emissive);
  if (has(shaders::FEATURE_SHEEN)) {
    constexpr float kMostPower = 1.0F / (0.07F * 0.07F);
    most += largest(material.sheenColor) * (2.0F * (2.0F + kMostPower) / (8.0F * kPi) + 0.42F);
  }
  if (has(shaders::FEATURE_CLEARCOAT)) {
    most += 2.0F * lobe(material.clearcoatRoughness, textured(shaders::SLOT_CLEARCOAT_ROUGHNESS)) + 0.42F;
  }
  return most;
}

} // namespace

float mostLight(const Scene& scene, const SceneDraws& draws) {
  float most = 0.0F;
  for (const GpuDraw& draw : draws.transparentDraws()) {
    most = std::max(most, mostOf(scene.materials.at(draw.material), draw.features));
  }
  return std::clamp(most, 0.0F, shaders::LARGEST_HALF);
}

} // namespace vitrail::tool
