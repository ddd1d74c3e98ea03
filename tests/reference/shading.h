// docs/shading.md in double precision, written from that page: colours, textures and curves of the reference renderer.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "../../tool/scene/scene.h"

namespace vitrail::tool::reference {

// One of the scene's lights at a point.
struct Shine {
  glm::dvec3 toLight{0.0, 0.0, 1.0}; // unit length
  glm::dvec3 strength{2.0};
};

// One point of a lit surface. All directions are unit length, in the world.
struct Surface {
  glm::dvec3 normal{0.0, 0.0, 1.0};  // N, already turned to the side that is seen
  glm::dvec3 toEye{0.0, 0.0, 1.0};   // V
  glm::dvec3 toLight{0.0, 0.0, 1.0}; // L, of the tool's own light
  bool ownLight = true;              // else `lights` shine
  std::vector<Shine> lights;
  glm::dvec3 base{1.0};
  glm::dvec3 emissive{0.0};
  double metallic = 1.0;
  double roughness = 1.0;
  double transmission = 0.0; // t of the section "Transmission"

  double ior = 1.5;
  double specular = 1.0;
  glm::dvec3 specularColor{1.0};
  bool specularGlossiness = false; // specularColor is F0
  double clearcoat = 0.0;
  double clearcoatRoughness = 0.0;
  glm::dvec3 sheenColor{0.0};
  double sheenRoughness = 0.0;
  double anisotropy = 0.0;
  double anisotropyRotation = 0.0;
  glm::dvec4 tangent{1.0, 0.0, 0.0, 1.0}; // w: which way the bitangent goes
  double iridescence = 0.0;
  double iridescenceIor = 1.3;
  double filmThickness = 400.0; // nanometres
  double diffuseTransmission = 0.0;
  glm::dvec3 diffuseTransmissionColor{1.0};
};

// A light of the scene, times the scene's exposure, as it reaches a point of the world.
Shine shineOf(const Light& light, double exposure, const glm::dvec3& point);

// The linear colour of the section "Colour", and C of "Transmission", with an occlusion of 1.
glm::dvec3 shade(const Surface& surface);

// The sky in a unit direction, linear.
glm::dvec3 skyColor(const glm::dvec3& direction);

// A texel filtered bilinearly from the base level: sRGB colour decoded to linear before it is filtered, linear alpha.
// `premultiplied`: colours are filtered times alpha and divided by the filtered alpha.
// The slot's image is set. `uv` is the vertex's; the slot's transform is applied here.
glm::dvec4 sampleColorTexture(const Image& image, const TextureSlot& slot, const glm::dvec2& uv,
                              bool premultiplied = false);

// The sRGB curve of IEC 61966-2-1, both ways, on [0, 1].
double decodeSrgb(double encoded);
double encodeSrgb(double linear);

// A value, clamped to [0, 1], as the nearest of 256 steps. A NaN is 0.
std::uint8_t quantize8(double value);

} // namespace vitrail::tool::reference
