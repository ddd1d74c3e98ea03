// The first dispatch of the compute resolve: one thread a pixel. Short lists are done here, longer ones are left to
// the dispatch for their length.
#version 460
#extension GL_GOOGLE_include_directive : require
#if VITRAIL_NETWORKS
#define VITRAIL_GROUPS
#endif
#include "group_counts.glsl"
#include "picture.glsl"
#include "vitrail/parts.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Leaves what `walk` has begun to follow to a later dispatch. Returns the fragments of the list, as far as it walks.
uint leaveForLater(uint pixelIndex, VitrailWalk walk) {
#ifdef VITRAIL_GROUPS
  VitrailParts parts = vitrailFindParts(walk);
  if (walk.count <= VITRAIL_MEDIUM_LIST) {
    leaveMedium(pixelIndex);
  } else if (walk.count <= VITRAIL_LONG_LIST) {
    leaveLong(pixelIndex, parts.near);
  } else {
    leaveLongest(pixelIndex, parts.near, parts.far);
  }
#else
  leaveLong(pixelIndex);
#endif
  return walk.count;
}

void resolvePixel(uvec2 local) {
  uint pixelIndex = local.y * parameters.width + local.x;
  uint head = heads[pixelIndex];
  uvec2 pixel = uvec2(parameters.x, parameters.y) + local;
  beginPixel(pixel);
  if (head == VITRAIL_END) {
#ifdef VITRAIL_MULTISAMPLED
    writePixel(pixel, vitrailNothing());
#endif
    return;
  }
  VitrailWalk walk = VitrailWalk(head, 0u, nodesInUse());
  VitrailResolved r;
  if (kCapped) {
    r = vitrailResolveCapped(head, nodesInUse());
  } else {
    r = vitrailResolveShort(walk);
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
  if (sums && (VITRAIL_NETWORKS == 0 || parameters.keepSums == 0u)) return;
  beginCounts();
  uvec2 local = gl_GlobalInvocationID.xy;
  if (local.x < parameters.width && local.y < parameters.height) handlePixel(local, sums);
  endCounts();
}
