// Transparent surfaces: each fragment goes on its pixel's list.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 2
#ifndef VITRAIL_BUFFER_REFERENCE // only a CPU driver is not given it (gpu/features.cpp)
#define VITRAIL_CPU_DRIVER
#endif
#include "vitrail/collect.glsl"

#include "stage/surface.glsl"

// Whether depths follow from gl_FragCoord.w: with a perspective camera.
layout(constant_id = 1) const bool kDepthFromW = false;

void collect(vec4 color, uint blend) {
  float depth = kDepthFromW ? fma(gl_FragCoord.w, frame.depth.y, frame.depth.x) : gl_FragCoord.z;
  vitrailCollect(color, blend, depth);
}

void main() {
  Surface surface = shadeSurface();
  if (has(FEATURE_TRANSMISSION)) {
    collect(reflectionOf(surface), VITRAIL_PREMULTIPLIED);
    collect(filterOf(surface), VITRAIL_MULTIPLY);
  } else {
    collect(vec4(surface.color, surface.alpha), has(FEATURE_ADDITIVE) ? VITRAIL_ADDITIVE : VITRAIL_OVER);
  }
}
