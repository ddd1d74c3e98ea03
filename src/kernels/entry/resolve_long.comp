// The second dispatch of the compute resolve where it does not sort by networks: one thread a list of any length.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "sink/picture.glsl"
#include "list/long.glsl"

layout(local_size_x = 32) in; // LONG_GROUP_LISTS

void main() {
  uint slot = deepGroup() * LONG_GROUP_LISTS + gl_LocalInvocationIndex;
  if (slot >= min(vitrailControl.classes[VITRAIL_CLASS_LONG].count, longPixels.length())) return;
  uint pixelIndex = longPixels[slot];
  beginPixel(imagePixel(pixelIndex));
  uint head = vitrailHeads[pixelIndex];
  VitrailSink r = vitrailLong(head, nodesInUse());
  vitrailHeads[pixelIndex] = head;
  writeDeepPixel(pixelIndex, r);
}
