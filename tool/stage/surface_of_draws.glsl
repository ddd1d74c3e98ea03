// Surfaces of all draws in one compute shader (SURFACE_OF_DRAWS), in place of those of one pipeline: what the features
// are, and where textures and all that a vertex shader hands over come from. A part of surface.glsl. The including
// shader declares
//
//   FrameData frame                           set 0, binding 0
//   materials[i].data, draws[i].textures[i]   of each material, and of each draw the numbers of its textures
//
// and sets what stands under "Of the surface" before it calls shadeSurface().
#ifndef VITRAIL_TOOL_SURFACE_OF_DRAWS_GLSL
#define VITRAIL_TOOL_SURFACE_OF_DRAWS_GLSL

layout(constant_id = 0) const uint kAnyFeatures = 0u; // that some draw has
layout(constant_id = 1) const uint kAllFeatures = 0u; // that every draw has
layout(constant_id = 2) const uint kTextures = 1u;    // how many there are

layout(set = 0, binding = 2, std430) readonly buffer LightBlock { LightData lights[]; };

const uint SURFACE_TEXTURES = 0xffffu; // the features that are textures

// Of the surface.
uint surfaceFeatures;
uint surfaceMaterial;
uint surfaceDraw;
bool surfaceFront;
vec3 surfaceToEye;             // of any length
vec3 surfacePlane;             // with FEATURE_FLAT: the normal of its plane, on one side or the other
vec4 surfaceTexCoords;         // both
vec4 surfaceTexCoordsRight;    // how they change from a pixel to the next
vec4 surfaceTexCoordsDown;
vec3 inPosition;
vec3 inNormal;
vec4 inTangent;
vec4 inColor;

bool surfaceCut; // set where a mask cuts it away

// What all draws have alike costs nothing to ask for.
bool has(uint feature) {
  return (kAnyFeatures & feature) != 0u && ((kAllFeatures & feature) != 0u || (surfaceFeatures & feature) != 0u);
}

#define material materials[surfaceMaterial].data
#define SURFACE_FRONT surfaceFront
#define SURFACE_DISCARD { surfaceCut = true; return Surface(vec3(0.0), 0.0, vec3(1.0), 0.0); }

vec3 wayToEye() { return surfaceToEye; }
vec3 planeNormal() { return has(FEATURE_FLAT) ? surfacePlane : vec3(0.0); }

#ifndef SURFACE_CONSTANT_TEXTURES
layout(set = 1, binding = 0) uniform sampler2D textures[kTextures];

vec4 surfaceTexture(uint number, vec2 at, vec2 right, vec2 down) {
  return textureGrad(textures[nonuniformEXT(number)], at, right, down);
}
#else
// For devices where only a constant chooses a texture.
layout(set = 1, binding = 0) uniform sampler2D textures[SURFACE_CONSTANT_TEXTURES];

vec4 surfaceTexture(uint number, vec2 at, vec2 right, vec2 down) {
  vec4 texel = vec4(1.0);
#define SURFACE_TRY(i) if (kTextures > i && number == i) texel = textureGrad(textures[i], at, right, down);
#define SURFACE_TRY_4(i) SURFACE_TRY(i) SURFACE_TRY(i + 1u) SURFACE_TRY(i + 2u) SURFACE_TRY(i + 3u)
  SURFACE_TRY_4(0u) SURFACE_TRY_4(4u) SURFACE_TRY_4(8u) SURFACE_TRY_4(12u) SURFACE_TRY_4(16u) SURFACE_TRY_4(20u)
  SURFACE_TRY_4(24u) SURFACE_TRY_4(28u)
  return texel;
}
#endif

vec4 surfaceTexel(uint slot) {
  SlotData data = material.slots[slot];
  bool second = data.row0.w > 0.5;
  vec3 at = vec3(second ? surfaceTexCoords.zw : surfaceTexCoords.xy, 1.0);
  vec2 right = second ? surfaceTexCoordsRight.zw : surfaceTexCoordsRight.xy;
  vec2 down = second ? surfaceTexCoordsDown.zw : surfaceTexCoordsDown.xy;
  return surfaceTexture(draws[surfaceDraw].textures[slot], vec2(dot(data.row0.xyz, at), dot(data.row1.xyz, at)),
                        vec2(dot(data.row0.xy, right), dot(data.row1.xy, right)),
                        vec2(dot(data.row0.xy, down), dot(data.row1.xy, down)));
}

#define TEXEL(slot, image) (hasTexture(slot) ? surfaceTexel(slot) : vec4(1.0))
bool hasTexture(uint slot);

#endif
