// The depth of the nearest opaque surface; 1 is nearest here, whatever it is in the image.
#extension GL_EXT_samplerless_texture_functions : require
#ifndef VITRAIL_RASTER_OPAQUE_GLSL
#define VITRAIL_RASTER_OPAQUE_GLSL

#include "samples.glsl"

#ifdef VITRAIL_MULTISAMPLED
layout(VITRAIL_RASTER_BOUND(10)) uniform texture2DMS vitrailDepthImage;

float vitrailStoredDepth(ivec2 pixel, uint sample_) { return texelFetch(vitrailDepthImage, pixel, int(sample_)).r; }
#else
layout(VITRAIL_RASTER_BOUND(10)) uniform texture2D vitrailDepthImage;

float vitrailStoredDepth(ivec2 pixel, uint sample_) { return texelFetch(vitrailDepthImage, pixel, 0).r; }
#endif

float vitrailOpaqueDepth(ivec2 pixel, uint sample_) {
  float depth = vitrailStoredDepth(pixel, sample_);
  return VITRAIL_RASTER_NEAREST_IS_ZERO ? 1.0 - depth : depth;
}

// The farthest of a pixel.
float vitrailFarthestDepth(ivec2 pixel) {
  float farthest = vitrailOpaqueDepth(pixel, 0u);
  for (uint i = 1u; i < VITRAIL_RASTER_SAMPLES; ++i) farthest = min(farthest, vitrailOpaqueDepth(pixel, i));
  return farthest;
}

#endif
