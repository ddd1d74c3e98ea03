// The first dispatch of the compute resolve: one thread a pixel. Short lists are done here, longer ones are left to the
// next dispatch.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "group_counts.glsl"
#include "picture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

VitrailResolved resolveList(uint head) {
  if (kCapped) return vitrailResolveCapped(head, nodesInUse());
  return vitrailResolveShort(head, nodesInUse());
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
  VitrailResolved r = resolveList(head);
  if (r.complete) {
    writePixel(pixel, r);
  } else {
    leaveForLater(pixelIndex);
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
