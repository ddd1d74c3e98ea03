// Sorts and blends the layers that the passes of the method stencil-routed have kept.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#include "vitrail/node.glsl"

#include "gpu/pixel_pass_shared.h"

layout(local_size_x = PIXEL_GROUP_SIDE, local_size_y = PIXEL_GROUP_SIDE) in;

layout(set = 0, binding = 3, rgba16f) uniform readonly image2DArray colors;
layout(set = 0, binding = 4, rgba16f) uniform readonly image2DArray opacities;
layout(set = 0, binding = 5, r32f) uniform readonly image2DArray depths;
layout(set = 0, binding = 6) uniform utexture2D counts; // of each pixel's surfaces
layout(set = 0, binding = 7, rgba16f) uniform image2D pictureImage;

ivec2 pixel;

uvec4 arrayKey(uint i) {
  ivec3 place = ivec3(pixel, i);
  vec3 color = imageLoad(colors, place).rgb;
  vec4 opacity = imageLoad(opacities, place);
  uint depth = vitrailDepthKey(vitrailDepthBits(imageLoad(depths, place).r, true), true);
  // Surfaces at equal depths are ordered by what they are, not by when they came; their tints by 8 bits a channel.
  uint tint = packUnorm4x8(vec4(0.0, opacity.rgb));
  return uvec4(depth, packHalf2x16(color.rg), packHalf2x16(vec2(color.b, opacity.a)), tint | i);
}

VitrailPair arrayPair(uvec4 key) {
  ivec3 place = ivec3(pixel, key.w & 0xffu); // there are at most 254
  return VitrailPair(imageLoad(colors, place).rgb, 1.0 - imageLoad(opacities, place));
}

#include "methods/shared/array_blend.glsl"

void main() {
  pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(pictureImage)))) return;
  uint count = texelFetch(counts, pixel, 0).r;
  if (count == 0u) return;
  VitrailPair front = VitrailPair(vec3(0.0), vec4(1.0));
  blendArray(count, front);
  vec4 behind = imageLoad(pictureImage, pixel);
  imageStore(pictureImage, pixel, vec4(front.color, 1.0 - front.transmittance.a) + front.transmittance * behind);
}
