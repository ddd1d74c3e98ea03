// docs/shading.md in double precision, written from that page: colours, textures and curves of the reference renderer.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "../../tool/scene/scene.h"

namespace vitrail::tool::reference {

// One point of a lit surface. All directions are unit length, in the world.
struct Surface {
  glm::dvec3 normal{0.0, 0.0, 1.0};  // N, already turned to the side that is seen
  glm::dvec3 toEye{0.0, 0.0, 1.0};   // V
  glm::dvec3 toLight{0.0, 0.0, 1.0}; // L
  glm::dvec3 base{1.0};
  glm::dvec3 emissive{0.0};
  double metallic = 1.0;
  double roughness = 1.0;
  double transmission = 0.0; // t of the section "Transmission"
};

// The linear colour of the section "Colour", and C of "Transmission", with an occlusion of 1.
glm::dvec3 shade(const Surface& surface);

// The sky in a unit direction, linear.
glm::dvec3 skyColor(const glm::dvec3& direction);

// A texel filtered bilinearly from the base level: sRGB colour decoded to linear before it is filtered, linear alpha.
// The slot's image is set. `uv` is the vertex's; the slot's transform is applied here.
glm::dvec4 sampleColorTexture(const Image& image, const TextureSlot& slot, const glm::dvec2& uv);

// The sRGB curve of IEC 61966-2-1, both ways, on [0, 1].
double decodeSrgb(double encoded);
double encodeSrgb(double linear);

// A value, clamped to [0, 1], as the nearest of 256 steps. A NaN is 0.
std::uint8_t quantize8(double value);

} // namespace vitrail::tool::reference
