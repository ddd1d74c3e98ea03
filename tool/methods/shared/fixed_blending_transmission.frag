// Transmissive surfaces for dual-source blending: what they reflect, and the factor of what is behind.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stage/surface_light.glsl"

layout(early_fragment_tests) in;

layout(location = 0, index = 0) out vec4 outColor;
layout(location = 0, index = 1) out vec4 outFactor;

void main() {
  SurfaceLight light = lightOf(shadeSurface());
  outColor = vec4(light.color, 1.0 - light.transmittance.a);
  outFactor = light.transmittance;
}
