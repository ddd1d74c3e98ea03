// Before a fragment resolve: finds the lists that are longer than it sorts itself, and counts for the statistics. One
// thread a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "group_counts.glsl"
#include "list/deep.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void findList(uint pixelIndex) {
  uint index = vitrailHeads[pixelIndex];
  if (index == VITRAIL_END) return;
  uint count = 0u;
  while (index < nodesInUse() && count < (kCapped ? nodesInUse() : VITRAIL_SHORT_LIST)) {
    index = vitrailLoadNext(index, vitrailNodes()) & vitrailNextMask(vitrailNodes());
    ++count;
  }
  countPixel(count);
  if (index < nodesInUse() && !kCapped) leaveForLater(pixelIndex, VitrailWalk(index, count, nodesInUse()));
}

void main() {
  beginCounts();
  uvec2 local = gl_GlobalInvocationID.xy;
  bool inside = isInArea(local);
  if (inside && !overflowed()) findList(pixelIndexOf(local));
  endCounts();
}
