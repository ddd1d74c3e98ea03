// The structures and constants that the tool's shaders and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_SHARED_H
#define VITRAIL_TOOL_SHARED_H

#include "gpu/glsl.h"

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace vitrail::tool::shaders {
using glm::mat4;
using glm::vec4;
} // namespace vitrail::tool::shaders
#endif

VITRAIL_SHARED_BEGIN

const uint POINT_SIZE_CONSTANT = 63u; // the specialization constant of surface.vert that is the size of points
const float LARGEST_HALF = 65504.0f;  // of 16-bit floats

// The texture slots of a material, which are also the bindings of its descriptor set. The last ten belong to
// extensions.
const uint SLOT_BASE_COLOR = 0u;
const uint SLOT_METALLIC_ROUGHNESS = 1u; // with FEATURE_SPECULAR_GLOSSINESS: specular colour and glossiness
const uint SLOT_NORMAL = 2u;
const uint SLOT_OCCLUSION = 3u;
const uint SLOT_EMISSIVE = 4u;
const uint SLOT_TRANSMISSION = 5u;
const uint SLOT_SPECULAR = 6u;
const uint SLOT_SPECULAR_COLOR = 7u;
const uint SLOT_CLEARCOAT = 8u;
const uint SLOT_CLEARCOAT_ROUGHNESS = 9u;
const uint SLOT_THICKNESS = 10u;
const uint SLOT_SHEEN_COLOR = 11u;
const uint SLOT_SHEEN_ROUGHNESS = 12u;
const uint SLOT_ANISOTROPY = 13u;
const uint SLOT_IRIDESCENCE = 14u;
const uint SLOT_IRIDESCENCE_THICKNESS = 15u;
const uint SLOT_COUNT = 16u;
const uint SLOT_PAIRS = 8u; // the coordinates of two slots are interpolated as one vector

// What a surface's pipeline is specialized for: bit i is slot i's texture, and the rest below.
const uint FEATURE_UNLIT = 0x10000u;
const uint FEATURE_MASK = 0x20000u;         // fragments below the cutoff are discarded
const uint FEATURE_VERTEX_COLOR = 0x40000u; // without it colours are exact: interpolating a constant rounds
const uint FEATURE_TRANSMISSION = 0x80000u; // light passes through, tinted
const uint FEATURE_ADDITIVE = 0x100000u;    // adds its light to what is behind it
const uint FEATURE_LIGHTS = 0x200000u;      // lit by the scene's own lights
const uint FEATURE_SPECULAR = 0x400000u;    // reflects otherwise than plain glass: KHR_materials_ior and _specular
const uint FEATURE_SPECULAR_GLOSSINESS = 0x800000u;
const uint FEATURE_CLEARCOAT = 0x1000000u;
const uint FEATURE_SHEEN = 0x2000000u;
const uint FEATURE_RARE = 0x4000000u;          // anisotropy, iridescence or diffuse transmission, or several of them
const uint FEATURE_PREMULTIPLIED = 0x8000000u; // the base colour texture holds colours times alpha
const uint FEATURE_FLAT = 0x10000000u;         // there are no vertex normals: each triangle has that of its plane
// What is drawn: triangles where neither of these bits is there.
const uint FEATURE_LINES = 0x20000000u;  // lines, a pixel wide, in place of triangles
const uint FEATURE_POINTS = 0x40000000u; // points
const uint FEATURE_SOLID = 0x60000000u;  // both: triangles that enclose a volume (below)
const uint FEATURE_VOLUME = 0x80000000u; // there is something behind it that absorbs light

const uint CLIP_PLANE_COUNT = 8u;

// What all draws of a frame share (std140).
struct FrameData {
  mat4 viewProjection;
  mat4 cameraToWorld;
  vec4 eye;     // xyz: the camera's position; w: 1 if orthographic
  vec4 toLight; // xyz: unit vector in the world; w: how many lights the scene has of its own
  vec4 ray;     // a pixel at (x, y) looks along (x * ray.x - ray.z, ray.w - y * ray.y, -1) in camera axes
  vec4 depth;   // a perspective camera's depths are depth.x + depth.y * gl_FragCoord.w; zw: 1/256 pixel in clip space
  // Points with dot(xyz, point) + w >= 0 are kept. Those that are not there keep everything.
  vec4 clipPlanes[CLIP_PLANE_COUNT];
};

const uint LIGHT_DIRECTIONAL = 0u;
const uint LIGHT_POINT = 1u;
const uint LIGHT_SPOT = 2u;

// One of the scene's lights (std430).
struct LightData {
  vec4 intensity; // rgb: colour times intensity times the scene's exposure
  vec4 position;  // xyz; w: one over its range, 0 where that is infinite
  vec4 direction; // xyz: unit length, where it shines; w: LIGHT_...
  vec4 cone;      // x, y: a spot's share at the cosine c from its direction is clamp(c * x + y, 0, 1)^2
};

// Where a texture slot samples: (u, v, 1) times two rows, row0.w: which texture coordinates, 0 or 1.
struct SlotData {
  vec4 row0;
  vec4 row1;
};

// One material (std140).
struct MaterialData {
  vec4 baseColor;
  vec4 emissive;    // rgb
  vec4 attenuation; // rgb: absorption times thickness, in the mesh's lengths
  float metallic;
  float roughness; // with FEATURE_SPECULAR_GLOSSINESS: 1 - glossiness
  float normalScale;
  float occlusionStrength;
  float alphaCutoff;
  float alphaFromBase; // 1: alpha is the base colour's; 0: alpha is 1
  float opacity;       // multiplies alpha
  float transmission;
  vec4 specularColor; // rgb: KHR_materials_specular's, or the reflectance of FEATURE_SPECULAR_GLOSSINESS; a: its factor
  vec4 sheen;         // rgb: colour; a: roughness
  vec4 diffuseTransmission; // rgb: colour; a: factor
  vec4 iridescence;         // factor, index of refraction, least and greatest thickness in nanometres
  vec4 anisotropy;          // strength; cosine and sine of the rotation
  float reflectance;        // of the dielectric seen straight on, from its index of refraction
  float clearcoat;
  float clearcoatRoughness;
  float materialPadding;
  SlotData slots[SLOT_COUNT];
};

#ifdef __cplusplus
static_assert(sizeof(FrameData) == 320);
static_assert(sizeof(SlotData) == 32);
static_assert(sizeof(LightData) == 64);
static_assert(sizeof(MaterialData) == 688);
#endif

VITRAIL_SHARED_END

#endif
