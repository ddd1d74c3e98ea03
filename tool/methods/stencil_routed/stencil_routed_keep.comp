// Ends a pass of the method stencil-routed: the samples of each pixel become layers of arrays, which all passes share.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/pixel_pass_shared.h"

layout(local_size_x = PIXEL_GROUP_SIDE, local_size_y = PIXEL_GROUP_SIDE) in;

layout(set = 0, binding = 0) uniform texture2DMS sampleColors;
layout(set = 0, binding = 1) uniform texture2DMS sampleOpacities;
layout(set = 0, binding = 2) uniform texture2DMS sampleDepths;
layout(set = 0, binding = 3, rgba16f) uniform writeonly image2DArray colors;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2DArray opacities;
layout(set = 0, binding = 5, r32f) uniform writeonly image2DArray depths;

layout(push_constant) uniform PassBlock {
  uint firstLayer;
  uint samples;
};

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(colors).xy))) return;
  for (int i = 0; i < int(samples); ++i) {
    ivec3 place = ivec3(pixel, int(firstLayer) + i);
    imageStore(colors, place, texelFetch(sampleColors, pixel, i));
    imageStore(opacities, place, texelFetch(sampleOpacities, pixel, i));
    imageStore(depths, place, texelFetch(sampleDepths, pixel, i));
  }
}
