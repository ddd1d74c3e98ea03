// The depth passes of the method stochastic: a surface hides what is behind it in a random part of its samples, as
// large as its opacity. What is random is a hash of pixel, pass and the fragment itself, so a frame is the same each
// time and in any order of submission.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stage/surface_light.glsl"

#include "stochastic_shared.h"

layout(constant_id = 1) const uint kSamples = 1u; // a power of two

layout(push_constant) uniform PassBlock { StochasticPass pass; };

// PCG in four dimensions: Jarzynski and Olano, "Hash Functions for GPU Rendering" (JCGT 9(3), 2020).
uvec4 randomBits(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v += v.yzxy * v.wxyz;
  v ^= v >> 16u;
  v += v.yzxy * v.wxyz;
  return v;
}

// Each sample has a threshold in a stratum of its own.
uint coverage(float opacity, uvec4 random) {
  float inStratum = float(random.x >> 8u) / 16777216.0;
  uint mask = 0u;
  for (uint i = 0u; i < kSamples; ++i) {
    uint stratum = (i * (random.y >> 16u | 1u) + (random.z >> 16u)) & (kSamples - 1u);
    if ((float(stratum) + inStratum) / float(kSamples) < opacity) mask |= 1u << i;
  }
  return mask;
}

void main() {
  SurfaceLight light = lightOf(shadeSurface());
  uint fragment = floatBitsToUint(gl_FragCoord.z) ^ floatBitsToUint(light.color.g) * 0x9e3779b9u;
  uvec4 seed = uvec4(uvec2(gl_FragCoord.xy), fragment, pass.number * 4u + pass.channel);
  uint mask = coverage(1.0 - light.transmittance[pass.channel], randomBits(seed));
  if (mask == 0u) discard;
  gl_SampleMask[0] = int(mask);
}
