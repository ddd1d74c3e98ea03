// The composite of the method weighted.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "methods/shared/composite.glsl"
#include "stage/surface_shared.h"

layout(set = 0, binding = FIRST_PLANE) uniform Plane bodyPlane;
layout(set = 0, binding = FIRST_PLANE + 1) uniform Plane throughPlane;
layout(set = 0, binding = FIRST_PLANE + 2) uniform Plane glowPlane;

vec4 composite(ivec2 pixel, int i, vec4 behind) {
  vec4 body = min(planeAt(bodyPlane, pixel, i), LARGEST_HALF); // where a sum is infinite, the surfaces look white
  vec4 through = planeAt(throughPlane, pixel, i);
  if (!kFilters) through = through.rrrr;
  float opacity = 1.0 - through.a;
  vec3 color = body.a > 0.0 ? body.rgb * (opacity / body.a) : vec3(0.0);
  if (kFilters) color += planeAt(glowPlane, pixel, i).rgb;
  return vec4(color, opacity) + through * behind;
}
