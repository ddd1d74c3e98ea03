// What the built-in scenes share: one make function a scene, and colours.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "../scene.h"
#include "../srgb.h"

namespace vitrail::tool {

// Each makes its scene as a pure function of count (at least 1) and seed.
Scene makeSpheres(std::uint32_t count, std::uint32_t seed);
Scene makePlanes(std::uint32_t count, std::uint32_t seed);
Scene makeInterlocked(std::uint32_t count, std::uint32_t seed);
Scene makeMannequins(std::uint32_t count, std::uint32_t seed);
Scene makeHairball(std::uint32_t count, std::uint32_t seed);
Scene makeSmoke(std::uint32_t count, std::uint32_t seed);
Scene makeFlames(std::uint32_t count, std::uint32_t seed);

// The linear colour of an HSV one on the sRGB curve. The hue counts turns, of any number.
glm::vec3 colorFromHue(float hue, float saturation, float value);

// A transparent dielectric material.
Material glassMaterial(const glm::vec3& linearColor, float alpha, float roughness);

// Adds a mesh or a material and returns its index.
std::uint32_t addMesh(Scene& scene, Mesh mesh);
std::uint32_t addMaterial(Scene& scene, Material material);

} // namespace vitrail::tool
