// The last pass of methods that draw into planes, images of their own as large as the picture: what a pixel's planes
// hold is put over the opaque scene, in every sample, and the mean goes into the picture. Included by a compute shader,
// whose planes begin at binding FIRST_PLANE, and which defines composite().
#ifndef VITRAIL_TOOL_COMPOSITE_GLSL
#define VITRAIL_TOOL_COMPOSITE_GLSL

#extension GL_EXT_samplerless_texture_functions : require

#include "gpu/pixel_pass_shared.h"

layout(local_size_x = PIXEL_GROUP_SIDE, local_size_y = PIXEL_GROUP_SIDE) in;

layout(constant_id = 0) const uint kSamples = 1u;
layout(constant_id = 1) const bool kFilters = false; // some surfaces add light or tint it: their planes are there

layout(set = 0, binding = 0, rgba16f) uniform image2D colorImage;
#ifdef SEVERAL_SAMPLES
#define Plane texture2DMS
layout(set = 0, binding = 1) uniform texture2DMS opaqueImage;
#else
#define Plane texture2D
#endif
#define FIRST_PLANE 2

// The light that reaches the viewer from a sample of a pixel, of which `behind` comes from the opaque scene.
vec4 composite(ivec2 pixel, int i, vec4 behind);

// A plane's value; with one sample `i` is 0, the mip level.
vec4 planeAt(Plane plane, ivec2 pixel, int i) { return texelFetch(plane, pixel, i); }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(colorImage)))) return;
  vec4 sum = vec4(0.0);
  for (int i = 0; i < int(kSamples); ++i) {
#ifdef SEVERAL_SAMPLES
    sum += composite(pixel, i, planeAt(opaqueImage, pixel, i));
#else
    sum += composite(pixel, i, imageLoad(colorImage, pixel));
#endif
  }
  imageStore(colorImage, pixel, sum / float(kSamples));
}

#endif
