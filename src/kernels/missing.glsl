// The sums of a pixel's fragments that found no node.
#ifndef VITRAIL_MISSING_GLSL
#define VITRAIL_MISSING_GLSL

#include "target.glsl"
#include "vitrail/sums.glsl"

VitrailSums readMissing(uint pixelIndex) {
  uint first = pixelIndex * VITRAIL_SUM_WORDS;
  VitrailSums sums = VITRAIL_NO_SUMS;
  sums.color = uvec3(pixelSums[first], pixelSums[first + 1u], pixelSums[first + 2u]);
  sums.opacity = pixelSums[first + 3u];
  sums.density = pixelSums[first + 4u];
  return sums;
}

// Sums are 0 when a frame begins. Only frames that overflow change that, and clean up after themselves.
void clearMissing(uint pixelIndex) {
  for (uint i = 0u; i < VITRAIL_SUM_WORDS; ++i) pixelSums[pixelIndex * VITRAIL_SUM_WORDS + i] = 0u;
}

#endif
