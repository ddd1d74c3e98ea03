// The sky of docs/shading.md.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "surface_shared.h"

layout(BOUND(0, 0, 5), std140) uniform FrameBlock { FrameData frame; };

layout(location = 0) out vec4 outColor;

void main() {
  vec4 ray = frame.ray;
  vec3 inCamera = vec3(gl_FragCoord.x * ray.x - ray.z, ray.w - gl_FragCoord.y * ray.y, -1.0);
  float y = normalize(mat3(frame.cameraToWorld) * inCamera).y;
  vec3 far = y >= 0.0 ? vec3(0.18, 0.36, 0.70) : vec3(0.30, 0.28, 0.26);
  outColor = vec4(mix(vec3(0.70, 0.78, 0.88), far, sqrt(abs(y))), 1.0);
}
