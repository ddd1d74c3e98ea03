// The first geometry pass of the method a-buffer: counts the fragments that each pixel can have.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stage/surface.glsl"

layout(early_fragment_tests) in;

layout(set = 2, binding = 0, std430) buffer OffsetsBlock { uint counts[]; };

layout(push_constant) uniform PictureBlock { uint width; };

void main() {
  if (has(FEATURE_MASK)) shadeSurface();
  uvec2 pixel = uvec2(gl_FragCoord.xy);
  atomicAdd(counts[pixel.y * width + pixel.x], has(FEATURE_TRANSMISSION) ? 2u : 1u);
}
