// Blends the two layers that a pass of the method dual-depth-peeling took: the nearer one under the front, the farther
// one over the picture; at the end, the front over the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "peeling_shared.h"

layout(local_size_x = PEELING_GROUP_SIDE, local_size_y = PEELING_GROUP_SIDE) in;

layout(set = 0, binding = 0, rgba16f) uniform readonly image2D layerFrontColor;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D layerFrontThrough;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D layerBackColor;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D layerBackThrough;
layout(set = 0, binding = 4, rgba16f) uniform image2D frontColor;
layout(set = 0, binding = 5, rgba16f) uniform image2D frontThrough;
layout(set = 0, binding = 6, rgba16f) uniform image2D pictureImage;

layout(push_constant) uniform StepBlock { uint last; }; // 1: no layers are left

// What surfaces at one depth do together, from the sum of their colours, the number of them, and the product of what
// they let through: exact for equal ones, which then are a geometric series.
vec4 together(vec4 sums, vec4 product) {
  float count = sums.a;
  vec3 color = sums.rgb;
  if (count > 1.0) {
    vec3 each = pow(max(product.rgb, vec3(0.0)), vec3(1.0 / count));
    vec3 hidden = 1.0 - each;
    color *= mix(vec3(1.0), (1.0 - product.rgb) / (count * max(hidden, vec3(1e-6))), greaterThan(hidden, vec3(1e-6)));
  }
  return vec4(color, 1.0 - product.a);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(pictureImage)))) return;
  vec4 color = imageLoad(frontColor, pixel);
  vec4 through = imageLoad(frontThrough, pixel);
  if (last == 1u) {
    imageStore(pictureImage, pixel, color + through * imageLoad(pictureImage, pixel));
    return;
  }
  vec4 nearer = imageLoad(layerFrontColor, pixel);
  if (nearer.a == 0.0) return; // the pixel has no more
  vec4 nearerThrough = imageLoad(layerFrontThrough, pixel);
  imageStore(frontColor, pixel, color + through * together(nearer, nearerThrough));
  imageStore(frontThrough, pixel, through * nearerThrough);
  vec4 farther = imageLoad(layerBackColor, pixel);
  if (farther.a == 0.0) return;
  vec4 fartherThrough = imageLoad(layerBackThrough, pixel);
  imageStore(pictureImage, pixel, together(farther, fartherThrough) + fartherThrough * imageLoad(pictureImage, pixel));
}
