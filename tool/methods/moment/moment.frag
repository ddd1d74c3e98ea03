// The second pass of the method moment: the light of surfaces, dimmed by what the moments say is before them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "stage/surface_light.glsl"

#include "moments.glsl"

layout(early_fragment_tests) in;

layout(set = 2, binding = 0) uniform texture2D momentsPlane;
layout(set = 2, binding = 1) uniform texture2D totalPlane;

layout(location = 0) out vec4 outLight; // added: dimmed light, and the opacity that goes with it

void main() {
  SurfaceLight light = lightOf(shadeSurface());
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float total = texelFetch(totalPlane, pixel, 0).r;
  float reaches = transmittanceAt(warpedDepth(viewDepth()), total, texelFetch(momentsPlane, pixel, 0));
  float opacity = 1.0 - exp(-absorbance(light.transmittance.rgb));
  outLight = min(reaches * vec4(light.color, opacity), LARGEST_HALF);
}
