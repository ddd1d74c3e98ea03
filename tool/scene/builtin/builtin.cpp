// The table of built-in scenes and what they share.
#include "builtin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "parts.h"

namespace vitrail::tool {
namespace {

constexpr std::array<BuiltinScene, 7> scenes{{
    {"spheres", "glass balls of random colours and opacities in a cube", "spheres", 64, 20000, makeSpheres},
    {"planes", "parallel panes that fill the picture, stored in random order", "panes", 32, 5000, makePlanes},
    {"interlocked", "panes and rings that pass through each other: no object order is right", "objects", 12, 5000,
     makeInterlocked},
    {"mannequins", "translucent figures and opaque teapots under a sky", "figures", 36, 1024, makeMannequins},
    {"hairball", "thousands of thin curved tubes around a core, over 100 layers deep", "tubes", 4000, 20000,
     makeHairball},
    {"smoke", "soft textured billboards, many deep", "billboards", 200, 20000, makeSmoke},
    {"flames", "the billboards of smoke as light without a body: they add up and hide nothing", "billboards", 200,
     20000, makeFlames},
}};

} // namespace

std::span<const BuiltinScene> builtinScenes() { return scenes; }

Scene makeBuiltinScene(std::string_view name, const BuiltinOptions& options) {
  const auto scene = std::ranges::find(scenes, name, &BuiltinScene::name);
  if (scene == scenes.end()) {
    std::string known;
    for (const BuiltinScene& each : scenes) known.append(known.empty() ? "" : ", ").append(each.name);
    throw std::invalid_argument("there is no scene \"" + std::string(name) + "\"; the scenes are " + known);
  }
  const std::uint32_t count = options.count.value_or(scene->defaultCount);
  if (count < 1 || count > scene->maxCount) {
    throw std::invalid_argument("the scene " + std::string(name) + " can have 1 to " + std::to_string(scene->maxCount) +
                                " " + std::string(scene->countMeaning) + ", not " + std::to_string(count));
  }
  return scene->make(count, options.seed);
}

glm::vec3 colorFromHue(float hue, float saturation, float value) {
  glm::vec3 srgb;
  for (int i = 0; i < 3; ++i) {
    const float turned = hue + static_cast<float>(3 - i) / 3.0F;
    const float distance = std::abs((turned - std::floor(turned)) * 6.0F - 3.0F); // 3 at this channel's own hue
    srgb[i] = value * (1.0F - saturation * (1.0F - std::clamp(distance - 1.0F, 0.0F, 1.0F)));
  }
  return linearFromSrgb(srgb);
}

Material glassMaterial(const glm::vec3& linearColor, float alpha, float roughness) {
  Material material;
  material.alphaMode = AlphaMode::Blend;
  material.doubleSided = true;
  material.baseColor = glm::vec4(linearColor, alpha);
  material.metallic = 0.0F;
  material.roughness = roughness;
  return material;
}

std::uint32_t addMesh(Scene& scene, Mesh mesh) {
  scene.meshes.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

std::uint32_t addMaterial(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

} // namespace vitrail::tool
