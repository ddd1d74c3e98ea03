#include "light_data.h"

#include <algorithm>
#include <cmath>

#include "../scene/exposure.h"

namespace vitrail::tool {

namespace {

shaders::LightData makeLight(const Light& light, double exposure, const glm::dvec3& origin) {
  constexpr double kLargest = 1e30; // of an intensity: products with it stay in the range of a float
  shaders::LightData data{};
  data.intensity = glm::vec4(glm::min(glm::dvec3(light.intensity) * exposure, glm::dvec3(kLargest)), 0.0);
  data.position = glm::vec4(glm::dvec3(light.position) - origin, light.range > 0.0F ? 1.0 / double{light.range} : 0.0);
  std::uint32_t kind = shaders::LIGHT_DIRECTIONAL;
  if (light.kind == Light::Kind::Point) kind = shaders::LIGHT_POINT;
  if (light.kind == Light::Kind::Spot) {
    kind = shaders::LIGHT_SPOT;
    const double outer = std::cos(double{light.outerConeAngle});
    const double scale = 1.0 / std::max(std::cos(double{light.innerConeAngle}) - outer, 0.001);
    data.cone = glm::vec4(scale, -outer * scale, 0.0, 0.0);
  }
  data.direction = glm::vec4(light.direction, static_cast<float>(kind));
  return data;
}

} // namespace

std::vector<shaders::LightData> makeLightData(const Scene& scene, const glm::dvec3& origin) {
  if (scene.lights.empty()) return {};
  const double exposure = lightExposure(scene);
  std::vector<shaders::LightData> data;
  data.reserve(scene.lights.size());
  for (const Light& light : scene.lights) data.push_back(makeLight(light, exposure, origin));
  return data;
}

} // namespace vitrail::tool
