// Transparent surfaces that are counted in 32 bits a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stage/surface.glsl"

layout(early_fragment_tests) in;

layout(BOUND(2, 0, 0), r32ui) uniform uimage2D counts;

void main() {
  if (has(FEATURE_MASK)) shadeSurface();
  imageAtomicAdd(counts, ivec2(gl_FragCoord.xy), 1u);
}
