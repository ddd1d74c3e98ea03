// Places a surface's vertices, for the opaque and the transparent pass alike.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "surface_shared.h"

layout(constant_id = 0) const uint kFeatures = 0u;

layout(set = 0, binding = 0, std140) uniform FrameBlock { FrameData frame; };
layout(set = 0, binding = 1, std140) uniform DrawBlock { DrawData draw; };
layout(set = 0, binding = 2, std140) uniform MaterialBlock { MaterialData material; };

layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec4 inTangent;
layout(location = 3) in vec2 inTexCoord0;
layout(location = 4) in vec2 inTexCoord1;
layout(location = 5) in vec4 inColor;

layout(location = 0) out vec3 outPosition;
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec4 outTangent;
layout(location = 3) out vec4 outColor;
layout(location = 4) out vec2 outTexCoords[SLOT_COUNT];

// Both passes must give one vertex the same bits, or transparent decals on opaque surfaces would flicker.
invariant gl_Position;

// Here and not in the fragment shader: what textures are sampled with is then interpolated and nothing else, and its
// derivatives do not rest on what a driver loads for helper invocations.
vec2 slotCoordinates(uint slot) {
  if ((kFeatures & 1u << slot) == 0u) return vec2(0.0);
  SlotData data = material.slots[slot];
  vec3 uv1 = vec3(data.row0.w > 0.5 ? inTexCoord1 : inTexCoord0, 1.0);
  return vec2(dot(data.row0.xyz, uv1), dot(data.row1.xyz, uv1));
}

void main() {
  vec4 position = draw.model * vec4(inPosition, 1.0);
  gl_Position = frame.viewProjection * position;
  outPosition = position.xyz;
  outNormal = draw.normal0.xyz * inNormal.x + draw.normal1.xyz * inNormal.y + draw.normal2.xyz * inNormal.z;
  // A mirror turns cross(normal, tangent) round, so the bitangent's sign turns with it.
  outTangent = vec4(mat3(draw.model) * inTangent.xyz, inTangent.w * draw.normal0.w);
  outColor = inColor;
  for (uint slot = 0u; slot < SLOT_COUNT; ++slot) outTexCoords[slot] = slotCoordinates(slot);
}
