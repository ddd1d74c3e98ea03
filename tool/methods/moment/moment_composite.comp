// The composite of the method moment.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "methods/shared/composite.glsl"

layout(set = 0, binding = FIRST_PLANE) uniform Plane lightPlane;
layout(set = 0, binding = FIRST_PLANE + 2) uniform Plane totalPlane;
layout(set = 0, binding = FIRST_PLANE + 3) uniform Plane throughPlane;

vec4 composite(ivec2 pixel, int i, vec4 behind) {
  vec4 light = planeAt(lightPlane, pixel, i);
  float mean = exp(-planeAt(totalPlane, pixel, i).r);
  vec4 through = kFilters ? planeAt(throughPlane, pixel, i) : vec4(mean);
  // What surfaces hide together is known: their estimated shares are scaled to it.
  vec3 color = light.rgb * (light.a > 0.0 ? (1.0 - mean) / light.a : 1.0);
  return vec4(color, 1.0 - through.a) + through * behind;
}
