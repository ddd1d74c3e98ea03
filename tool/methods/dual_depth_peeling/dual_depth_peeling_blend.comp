// Blends the two layers that a pass of the method dual-depth-peeling took: the nearer one under the front, the farther
// one over the back, which is the picture at first; at the end, the front over the back.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "methods/shared/peeling_shared.h"
#include "gpu/pixel_pass_shared.h"

layout(local_size_x = PIXEL_GROUP_SIDE, local_size_y = PIXEL_GROUP_SIDE) in;

layout(set = 0, binding = 0, rgba16f) uniform readonly image2D layerFrontColor;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D layerFrontOpacity;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D layerBackColor;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D layerBackOpacity;
layout(set = 0, binding = 4, rgba32f) uniform image2D frontColor;
layout(set = 0, binding = 5, rgba32f) uniform image2D frontThrough;
layout(set = 0, binding = 6, rgba32f) uniform image2D backImage;
layout(set = 0, binding = 7, rgba16f) uniform image2D pictureImage;

layout(push_constant) uniform StepBlock { uint step; }; // PEELING_*

// What surfaces at one depth do together, from the sum of their colours, the number of them, and their opacity: exact
// for equal ones, which then are a geometric series.
vec4 together(vec4 sums, vec4 opacity) {
  float count = sums.a;
  vec3 color = sums.rgb;
  if (count > 1.0) {
    vec3 each = 1.0 - pow(max(1.0 - opacity.rgb, vec3(0.0)), vec3(1.0 / count));
    color *= mix(vec3(1.0), opacity.rgb / (count * max(each, vec3(1e-6))), greaterThan(each, vec3(1e-6)));
  }
  return vec4(color, opacity.a);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(pictureImage)))) return;
  vec4 color = imageLoad(frontColor, pixel);
  vec4 through = imageLoad(frontThrough, pixel);
  vec4 back = step == PEELING_FIRST ? imageLoad(pictureImage, pixel) : imageLoad(backImage, pixel);
  if (step == PEELING_LAST) {
    imageStore(pictureImage, pixel, color + through * back);
    return;
  }
  vec4 nearer = imageLoad(layerFrontColor, pixel);
  if (nearer.a > 0.0) {
    vec4 opacity = imageLoad(layerFrontOpacity, pixel);
    imageStore(frontColor, pixel, color + through * together(nearer, opacity));
    imageStore(frontThrough, pixel, through * (1.0 - opacity));
  }
  vec4 farther = imageLoad(layerBackColor, pixel);
  if (farther.a > 0.0) {
    vec4 opacity = imageLoad(layerBackOpacity, pixel);
    back = together(farther, opacity) + (1.0 - opacity) * back;
  }
  imageStore(backImage, pixel, back);
}
