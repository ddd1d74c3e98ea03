// Places a surface's vertices, for the opaque and the transparent pass alike.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "surface_shared.h"

CONSTANT(0, uint kFeatures, 0u)
CONSTANT(63, float kPointSize, 1.0) // POINT_SIZE_CONSTANT

layout(BOUND(0, 0, 5), std140) uniform FrameBlock { FrameData frame; };
layout(BOUND(0, 1, 6), std140) uniform MaterialBlock { MaterialData material; };

layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec2 inNormal;   // octahedral (tool/scene/scene.h)
layout(location = 2) in ivec2 inTangent; // octahedral, and a sign in the last bit of y
layout(location = 3) in vec2 inTexCoord0;
layout(location = 4) in vec2 inTexCoord1;
layout(location = 5) in vec4 inColor;
// The instance's transform to the world: rows.
layout(location = 6) in vec4 inRow0;
layout(location = 7) in vec4 inRow1;
layout(location = 8) in vec4 inRow2;

layout(location = 0) out vec3 outPosition;
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec4 outTangent;
layout(location = 3) out vec4 outColor;
layout(location = 4) out vec4 outTexCoords[SLOT_PAIRS];
#ifdef SURFACE_OBJECT
layout(location = 15) flat out uint outObject; // the number of the instance
#ifdef VITRAIL_OPENGL // which counts from the first of a draw
layout(location = 0) uniform uint firstInstance;
uint instanceNumber() { return firstInstance + uint(gl_InstanceID); }
#else
uint instanceNumber() { return uint(gl_InstanceIndex); }
#endif
#endif

// Both passes must give one vertex the same bits, or transparent decals on opaque surfaces would flicker.
invariant gl_Position;

#ifdef SURFACE_CLIPPED
out float gl_ClipDistance[CLIP_PLANE_COUNT];

void clip(vec3 position) {
  for (uint i = 0u; i < CLIP_PLANE_COUNT; ++i) {
    gl_ClipDistance[i] = dot(frame.clipPlanes[i], vec4(position, 1.0));
  }
}
#endif

// Here and not in the fragment shader: what textures are sampled with is then interpolated and nothing else, and its
// derivatives do not rest on what a driver loads for helper invocations.
vec2 slotCoordinates(uint slot) {
  if ((kFeatures & 1u << slot) == 0u) return vec2(0.0);
  SlotData data = material.slots[slot];
  vec3 uv1 = vec3(data.row0.w > 0.5 ? inTexCoord1 : inTexCoord0, 1.0);
  return vec2(dot(data.row0.xyz, uv1), dot(data.row1.xyz, uv1));
}

vec3 fromOctahedral(vec2 p) {
  vec3 v = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float fold = max(-v.z, 0.0);
  v.x -= v.x < 0.0 ? -fold : fold;
  v.y -= v.y < 0.0 ? -fold : fold;
  return normalize(v);
}

void main() {
  vec4 local = vec4(inPosition, 1.0);
  vec4 position = vec4(dot(inRow0, local), dot(inRow1, local), dot(inRow2, local), 1.0);
  gl_Position = frame.viewProjection * position;
  // Along the edge between two rows or columns of pixels a line is drawn in the lower or right one, on every device.
  if ((kFeatures & FEATURE_SOLID) == FEATURE_LINES) gl_Position.xy += gl_Position.w * frame.depth.zw;
  if ((kFeatures & FEATURE_SOLID) == FEATURE_POINTS) gl_PointSize = kPointSize;
#ifdef SURFACE_CLIPPED
  clip(position.xyz);
#endif
  outPosition = position.xyz;

  // Normals turn as planes do: by the cofactors, which exist even where the transform has no inverse, scaled so that
  // their squares stay in the range of a float. A mirror's cofactors point inwards, and it turns cross(normal, tangent)
  // round: the sign of both turns with it.
  vec3 largest = max(max(abs(inRow0.xyz), abs(inRow1.xyz)), abs(inRow2.xyz));
  float size = max(max(largest.x, largest.y), largest.z);
  mat3 rows = mat3(inRow0.xyz, inRow1.xyz, inRow2.xyz) * (size > 0.0 ? 1.0 / size : 0.0);
  mat3 cofactors = mat3(cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1]));
  float mirrored = dot(rows[0], cofactors[0]) < 0.0 ? -1.0 : 1.0;
  outNormal = mirrored * (fromOctahedral(inNormal) * cofactors);
  vec3 tangent = fromOctahedral(vec2(float(inTangent.x) / 32767.0, float(inTangent.y >> 1) / 16383.0));
  outTangent = vec4(tangent * rows, (inTangent.y & 1) != 0 ? -mirrored : mirrored);
  // Beside the sign w then says how much longer things become: no output more for the few that ask.
  if ((kFeatures & FEATURE_VOLUME) != 0u) outTangent.w *= size * pow(abs(dot(rows[0], cofactors[0])), 1.0 / 3.0);
  outColor = inColor;
#ifdef SURFACE_OBJECT
  outObject = instanceNumber();
#endif
  for (uint pair = 0u; pair < SLOT_PAIRS; ++pair) {
    outTexCoords[pair] = vec4(slotCoordinates(2u * pair), slotCoordinates(2u * pair + 1u));
  }
}
