// A pass of the method depth-peeling: of each pixel's surfaces, those that no pass has taken go on to the depth test,
// which leaves the nearest of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "methods/shared/layer.glsl"

layout(BOUND(2, 0, 16)) uniform TEXTURE_2D opaqueDepth;
layout(BOUND(2, 1, 5), rg32ui) uniform readonly uimage2D takenImage; // by the last pass: depth and number

PUSHED DrawBlock { uint firstTriangle; }; // of the draw, in the order of submission

layout(location = 0) out vec4 outColor;
layout(location = 1) out vec4 outOpacity;
layout(location = 2) out uvec2 outTaken;

// Whether the fragment comes after the last one that was taken: it is farther away, or as far and drawn later.
bool remains(uvec2 mine, ivec2 pixel) {
  uvec2 taken = imageLoad(takenImage, pixel).xy;
  bool after = mine.x < taken.x || (mine.x == taken.x && mine.y > taken.y);
  return after && gl_FragCoord.z >= texelFetch(opaqueDepth, pixel, 0).r;
}

void main() {
  uvec2 mine = uvec2(floatBitsToUint(gl_FragCoord.z), firstTriangle + uint(gl_PrimitiveID) + 1u); // 0: none
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (!shadesFirst() && !remains(mine, pixel)) discard;
  SurfaceLight layer = lightOf(shadeSurface());
  if (shadesFirst() && !remains(mine, pixel)) discard;
  outColor = vec4(layer.color, 0.0);
  outOpacity = opacityOf(layer);
  outTaken = mine;
}
