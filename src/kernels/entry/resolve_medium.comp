// The second dispatch of the compute resolve: one thread a list of up to 32 fragments.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_GROUPS
#include "picture.glsl"

layout(local_size_x = 128) in; // MEDIUM_GROUP_LISTS

void main() {
  uint slot = deepGroup() * MEDIUM_GROUP_LISTS + gl_LocalInvocationIndex;
  if (slot >= min(control.classes[VITRAIL_CLASS_MEDIUM].count, mediumPixels.length())) return;
  uint pixelIndex = mediumPixels[slot];
  beginPixel(imagePixel(pixelIndex));
  writeDeepPixel(pixelIndex, vitrailResolveMedium(heads[pixelIndex], nodesInUse()));
}
