// The composite of the method stochastic.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "methods/shared/composite.glsl"

layout(set = 0, binding = FIRST_PLANE) uniform Plane lightPlane;
layout(set = 0, binding = FIRST_PLANE + 1) uniform Plane throughPlane;

vec4 composite(ivec2 pixel, int i, vec4 behind) {
  vec4 through = planeAt(throughPlane, pixel, i);
  if (!kFilters) through = through.rrrr;
  return vec4(planeAt(lightPlane, pixel, i).rgb, 1.0 - through.a) + through * behind;
}
