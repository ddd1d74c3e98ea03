// The first half of a pass of the method reverse-depth-peeling: of each pixel's surfaces, those in front of the last
// layer go on to the depth test, which leaves the depth of the farthest of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "stage/surface.glsl"

layout(set = 2, binding = 0) uniform texture2D lastDepth;

layout(push_constant) uniform PassBlock { uint first; }; // 1: the last depth is the opaque scene's

void main() {
  if (has(FEATURE_MASK)) shadeSurface();
  float last = texelFetch(lastDepth, ivec2(gl_FragCoord.xy), 0).r;
  if (first != 0u ? gl_FragCoord.z < last : gl_FragCoord.z <= last) discard;
}
