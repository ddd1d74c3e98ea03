#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texCoord;

layout(location = 0) out vec3 outPosition;
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec2 outTexCoord;

void main() {
  outPosition = toWorld(gl_InstanceIndex, position);
  outNormal = turned(gl_InstanceIndex, normal);
  outTexCoord = texCoord;
  gl_Position = toClip(outPosition);
}
