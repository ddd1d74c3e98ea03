// The second dispatch of the compute resolve: one thread a list of up to 32 fragments. Longer ones are left to the
// third.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"

layout(local_size_x = 128) in; // DEEP_GROUP_SIZE

void main() {
  uint slot = deepSlot();
  if (slot >= min(control.mediumLists, uint(mediumPixels.length()))) return;
  uint pixelIndex = mediumPixels[slot];
  beginPixel(imagePixel(pixelIndex));
  VitrailResolved r = vitrailResolveMedium(heads[pixelIndex], nodesInUse());
  if (r.complete) {
    writeDeepPixel(pixelIndex, r);
  } else {
    leaveLong(pixelIndex);
  }
}
