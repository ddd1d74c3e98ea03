// The first dispatch of the compute resolve: one thread a pixel. Short lists are done here, longer ones are left to the
// next dispatch.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "group_counts.glsl"
#include "missing.glsl"
#include "picture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

VitrailResolved resolveList(uint head) {
  if (kMaxLayers != 0u && kMaxLayers <= VITRAIL_SHORT_LIST) return vitrailResolveCapped(head, nodesInUse());
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

#if VITRAIL_NETWORKS
// A frame that overflowed, where a dispatch of its own would cost more than the code.
void blendSums(uvec2 local) {
  uint pixelIndex = local.y * parameters.width + local.x;
  uint head = heads[pixelIndex];
  VitrailResolved r = vitrailResolveSums(head, nodesInUse(), readMissing(pixelIndex));
  clearMissing(pixelIndex);
  writePixel(imagePixel(pixelIndex), r);
  if (head != VITRAIL_END) countPixel(r.layers);
}
#else
void blendSums(uvec2 local) {} // resolve_overflow.comp does it
#endif

void main() {
  bool sums = overflowed();
  if (sums && (VITRAIL_NETWORKS == 0 || parameters.keepSums == 0u)) return;
  beginCounts();
  uvec2 local = gl_GlobalInvocationID.xy;
  if (local.x < parameters.width && local.y < parameters.height) {
    if (sums) {
      blendSums(local);
    } else {
      resolvePixel(local);
    }
  }
  endCounts();
}
