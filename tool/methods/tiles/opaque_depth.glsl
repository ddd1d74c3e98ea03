#extension GL_EXT_samplerless_texture_functions : require
#ifndef VITRAIL_TOOL_TILES_OPAQUE_DEPTH_GLSL
#define VITRAIL_TOOL_TILES_OPAQUE_DEPTH_GLSL

#include "samples.glsl"
#include "tiles_frame.glsl"

#ifdef TILES_MSAA
layout(set = 3, binding = 10) uniform texture2DMS depthImage;

// The nearest opaque surface's.
float opaqueDepth(ivec2 pixel, uint sample_) { return texelFetch(depthImage, pixel, int(sample_)).r; }
#else
layout(set = 3, binding = 10) uniform texture2D depthImage;

float opaqueDepth(ivec2 pixel, uint sample_) { return texelFetch(depthImage, pixel, 0).r; }
#endif

// The farthest of a pixel.
float farthestDepth(ivec2 pixel) {
  float farthest = opaqueDepth(pixel, 0u);
  for (uint i = 1u; i < kSamples; ++i) farthest = min(farthest, opaqueDepth(pixel, i));
  return farthest;
}


#endif
