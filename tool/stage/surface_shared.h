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

const float LARGEST_HALF = 65504.0f; // of 16-bit floats

// The texture slots of a material, which are also the bindings of its descriptor set.
const uint SLOT_BASE_COLOR = 0u;
const uint SLOT_METALLIC_ROUGHNESS = 1u;
const uint SLOT_NORMAL = 2u;
const uint SLOT_OCCLUSION = 3u;
const uint SLOT_EMISSIVE = 4u;
const uint SLOT_TRANSMISSION = 5u;
const uint SLOT_COUNT = 6u;

// What a surface's pipeline is specialized for: bit i is slot i's texture, and the rest below.
const uint FEATURE_UNLIT = 64u;
const uint FEATURE_MASK = 128u;         // fragments below the cutoff are discarded
const uint FEATURE_VERTEX_COLOR = 256u; // without it colours are exact: interpolating a constant rounds
const uint FEATURE_TRANSMISSION = 512u; // light passes through, tinted
const uint FEATURE_ADDITIVE = 1024u;    // adds its light to what is behind it
const uint FEATURE_FLAT = 2048u;        // there are no vertex normals: each triangle has that of its plane

const uint CLIP_PLANE_COUNT = 8u;

// What all draws of a frame share (std140).
struct FrameData {
  mat4 viewProjection;
  mat4 cameraToWorld;
  vec4 eye;     // xyz: the camera's position; w: 1 if orthographic
  vec4 toLight; // xyz: unit vector in the world
  vec4 ray;     // a pixel at (x, y) looks along (x * ray.x - ray.z, ray.w - y * ray.y, -1) in camera axes
  vec4 depth;   // a perspective camera's depths are depth.x + depth.y * gl_FragCoord.w
  // Points with dot(xyz, point) + w >= 0 are kept. Those that are not there keep everything.
  vec4 clipPlanes[CLIP_PLANE_COUNT];
};

// Where a texture slot samples: (u, v, 1) times two rows, row0.w: which texture coordinates, 0 or 1.
struct SlotData {
  vec4 row0;
  vec4 row1;
};

// One material (std140).
struct MaterialData {
  vec4 baseColor;
  vec4 emissive; // rgb
  float metallic;
  float roughness;
  float normalScale;
  float occlusionStrength;
  float alphaCutoff;
  float alphaFromBase; // 1: alpha is the base colour's; 0: alpha is 1
  float opacity;       // multiplies alpha
  float transmission;
  SlotData slots[SLOT_COUNT];
};

#ifdef __cplusplus
static_assert(sizeof(FrameData) == 320);
static_assert(sizeof(SlotData) == 32);
static_assert(sizeof(MaterialData) == 256);
#endif

VITRAIL_SHARED_END

#endif
