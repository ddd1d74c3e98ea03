// Before a fragment resolve: finds the lists that are longer than it sorts itself, and counts for the statistics. One
// thread a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "deep_lists.glsl"
#include "group_counts.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void findList(uint pixelIndex) {
  uint index = heads[pixelIndex];
  if (index == VITRAIL_END) return;
  uint count = 0u;
  while (index < nodesInUse() && count < (kCapped ? nodesInUse() : VITRAIL_SHORT_LIST)) {
    index = vitrailLoadNext(index, vitrailNodes()) & vitrailNextMask(vitrailNodes());
    ++count;
  }
  countPixel(count);
  if (index < nodesInUse() && !kCapped) leaveLong(pixelIndex);
}

void main() {
  beginCounts();
  uvec2 local = gl_GlobalInvocationID.xy;
  bool inside = local.x < parameters.width && local.y < parameters.height;
  if (inside && !overflowed()) findList(local.y * parameters.width + local.x);
  endCounts();
}
