// A pass of the method dual-depth-peeling: of each pixel's surfaces, those at the nearest and the farthest depth that
// the last pass found are this pass's two layers; among those between them the blending finds the next two depths.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "methods/shared/layer.glsl"

layout(early_fragment_tests) in;

layout(set = 2, binding = 0) uniform texture2D foundImage;

layout(location = 0) out vec2 outFound; // the largest of the depth and of its negative
layout(location = 1) out vec4 outFrontColor; // sums; a: how many
layout(location = 2) out vec4 outFrontOpacity; // of all together
layout(location = 3) out vec4 outBackColor;
layout(location = 4) out vec4 outBackOpacity;

const vec2 NOTHING = vec2(-2.0);

void main() {
  vec2 found = texelFetch(foundImage, ivec2(gl_FragCoord.xy), 0).rg;
  float depth = gl_FragCoord.z;
  bool isFront = depth == found.x;
  bool isBack = !isFront && depth == -found.y;
  bool isBetween = depth < found.x && depth > -found.y;
  outFound = isBetween ? vec2(depth, -depth) : NOTHING;
  outFrontColor = outFrontOpacity = outBackColor = outBackOpacity = vec4(0.0);
  if (!shadesFirst() && !has(FEATURE_MASK) && !isFront && !isBack) return;
  SurfaceLight layer = lightOf(shadeSurface());
  if (isFront) {
    outFrontColor = vec4(layer.color, 1.0);
    outFrontOpacity = opacityOf(layer);
  } else if (isBack) {
    outBackColor = vec4(layer.color, 1.0);
    outBackOpacity = opacityOf(layer);
  }
}
