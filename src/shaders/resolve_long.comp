// The third dispatch of the compute resolve: one thread a list of any length.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "vitrail/resolve_runs.glsl"

layout(local_size_x = 128) in; // DEEP_GROUP_SIZE

void main() {
  uint slot = deepSlot();
  if (slot >= min(control.longLists, uint(longPixels.length()))) return;
  uint pixelIndex = longPixels[slot];
  beginPixel(imagePixel(pixelIndex));
#if VITRAIL_NETWORKS
  writeDeepPixel(pixelIndex, vitrailResolveRuns(heads[pixelIndex], nodesInUse()));
#else
  writeDeepPixel(pixelIndex, vitrailResolveLong(heads[pixelIndex], nodesInUse()));
#endif
}
