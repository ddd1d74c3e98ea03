// The first half of a pass of the method reverse-depth-peeling: of each pixel's surfaces, those in front of the last
// layer go on to the depth test, which leaves the depth of the farthest of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "stage/surface.glsl"

layout(set = 2, binding = 0) uniform texture2D lastDepth;

void main() {
  if (has(FEATURE_MASK)) shadeSurface();
  if (gl_FragCoord.z <= texelFetch(lastDepth, ivec2(gl_FragCoord.xy), 0).r) discard;
}
