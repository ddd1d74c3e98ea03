// Puts the layer that a pass of the method depth-peeling took under those that are nearer; at the end, the picture
// under them all.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "methods/shared/peeling_shared.h"
#include "gpu/pixel_pass_shared.h"

layout(local_size_x = PIXEL_GROUP_SIDE, local_size_y = PIXEL_GROUP_SIDE) in;

layout(BOUND(0, 0, 0), rgba16f) uniform readonly image2D layerColor;
layout(BOUND(0, 1, 1), rgba16f) uniform readonly image2D layerOpacity;
layout(BOUND(0, 2, 2), rg32ui) uniform readonly uimage2D layerTaken;
layout(BOUND(0, 3, 3), rgba32f) uniform image2D frontColor;
layout(BOUND(0, 4, 4), rgba32f) uniform image2D frontThrough;
layout(BOUND(0, 5, 5), rg32ui) uniform writeonly uimage2D takenImage;
layout(BOUND(0, 6, 6), rgba16f) uniform image2D pictureImage;

PUSHED StepBlock { uint step; }; // PEELING_NEXT; after the last layer PEELING_LAST

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(pictureImage)))) return;
  vec4 color = imageLoad(frontColor, pixel);
  vec4 through = imageLoad(frontThrough, pixel);
  if (step == PEELING_LAST) {
    vec4 behind = imageLoad(pictureImage, pixel);
    imageStore(pictureImage, pixel, vec4(color.rgb, 1.0 - through.a) + through * behind);
    return;
  }
  uvec2 taken = imageLoad(layerTaken, pixel).xy;
  if (taken.y == 0u) return; // the pixel has no more
  imageStore(frontColor, pixel, color + through * imageLoad(layerColor, pixel));
  imageStore(frontThrough, pixel, through * (1.0 - imageLoad(layerOpacity, pixel)));
  imageStore(takenImage, pixel, uvec4(taken, 0u, 0u));
}
