// The picture without what is transparent: the mean of each pixel's samples.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "samples.glsl"
#include "tiles_frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 3, binding = 9, rgba16f) uniform writeonly image2D colorImage;
layout(set = 3, binding = 18) uniform texture2DMS opaqueImage;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, tiles.top);
  if (pixel.x >= int(tiles.width) || pixel.y >= int(tiles.bottom)) return;
  vec4 sum = vec4(0.0);
  for (uint i = 0u; i < kSamples; ++i) sum += texelFetch(opaqueImage, pixel, int(i));
  imageStore(colorImage, pixel, sum / float(kSamples));
}
