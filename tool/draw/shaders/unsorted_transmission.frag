// Transmissive surfaces for dual-source blending: what they reflect, and the factor of what is behind.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "surface.glsl"

layout(early_fragment_tests) in;

layout(location = 0, index = 0) out vec4 outColor;
layout(location = 0, index = 1) out vec4 outFactor;

const float LARGEST_HALF = 65504.0;

void main() {
  Surface surface = shadeSurface();
  vec4 reflection = reflectionOf(surface);
  vec4 through = filterOf(surface);
  float passes = 1.0 - reflection.a;
  outColor = vec4(min(reflection.rgb, LARGEST_HALF), reflection.a);
  outFactor = vec4(passes * mix(vec3(1.0), through.rgb, through.a), passes); // a filter leaves the picture's alpha
}
