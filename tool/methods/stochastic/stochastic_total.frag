// The first pass of the method stochastic: what all surfaces together let through.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stage/surface_light.glsl"

layout(early_fragment_tests) in;

layout(location = 0) out vec4 outThrough; // multiplied

void main() { outThrough = lightOf(shadeSurface()).transmittance; }
