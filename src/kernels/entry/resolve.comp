// The first dispatch of the compute resolve: one thread a pixel. Short lists are done here, longer ones are left to
// the dispatch for their length.
#version 460
#extension GL_GOOGLE_include_directive : require
#if VITRAIL_NETWORKS
#define VITRAIL_GROUPS
#endif
#include "group_counts.glsl"
#include "sink/picture.glsl"
#include "list/capped.glsl"
#include "list/short.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void resolvePixel(uvec2 local) {
  uint pixelIndex = pixelIndexOf(local);
  uint head = vitrailHeads[pixelIndex];
  uvec2 pixel = uvec2(vitrailParameters.x, vitrailParameters.y) + local;
  beginPixel(pixel);
  if (head == VITRAIL_END) {
#ifdef VITRAIL_MULTISAMPLED
    writePixel(pixel, vitrailBegin());
#endif
    return;
  }
  VitrailWalk walk = VitrailWalk(head, 0u, nodesInUse());
  VitrailSink r;
  if (kCapped) {
    r = vitrailCapped(head, nodesInUse());
  } else {
    r = vitrailShort(walk);
  }
  if (r.complete) {
    writePixel(pixel, r);
  } else {
    r.layers = leaveForLater(pixelIndex, walk);
  }
  countPixel(r.layers);
}

void handlePixel(uvec2 local, bool sums) {
#if VITRAIL_NETWORKS
  if (sums) { // else resolve_overflow.comp does it: a dispatch of its own costs less than the code
    uint layers = writeSums(local);
    if (layers > 0u) countPixel(layers);
    return;
  }
#endif
  resolvePixel(local);
}

void main() {
  bool sums = overflowed();
  if (sums && (VITRAIL_NETWORKS == 0 || vitrailParameters.keepSums == 0u)) return;
  beginCounts();
  uvec2 local = gl_GlobalInvocationID.xy;
  if (isInArea(local)) handlePixel(local, sums);
  endCounts();
}
