// The resolve of the method multi-layer: the layers, which are in order, front to back over the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "multi_layer.glsl"
#include "gpu/pixel_pass_shared.h"

layout(local_size_x = PIXEL_GROUP_SIDE, local_size_y = PIXEL_GROUP_SIDE) in;

layout(constant_id = 1) const uint kLayers = 4u;

layout(set = 0, binding = 0, std430) readonly buffer LayersBlock { uint layers[]; };
layout(set = 0, binding = 1, rgba16f) uniform image2D colorImage;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(colorImage);
  if (any(greaterThanEqual(pixel, size))) return;
  Layer all = Layer(1.0, vec3(0.0), vec4(1.0));
  uint found = 0u;
  for (; found < kLayers; ++found) {
    uint words[LAYER_WORDS];
    for (uint i = 0u; i < LAYER_WORDS; ++i) {
      words[i] = layers[(found * LAYER_WORDS + i) * uint(size.x * size.y) + uint(pixel.y * size.x + pixel.x)];
    }
    Layer layer = unpackLayer(words);
    if (layer.depth < 0.0) break;
    all = mergedLayers(all, layer);
  }
  if (found == 0u) return;
  vec4 behind = imageLoad(colorImage, pixel);
  imageStore(colorImage, pixel, vec4(all.color, 1.0 - all.transmittance.a) + all.transmittance * behind);
}
