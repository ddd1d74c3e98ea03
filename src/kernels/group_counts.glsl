// Counts pixels for the statistics. With networks (target.glsl) that is one atomic a work group and, where it is deeper
// than those before, another. Without, it is one a pixel: a CPU that waits for a work group puts all that its threads
// hold aside, which takes longer.
#ifndef VITRAIL_GROUP_COUNTS_GLSL
#define VITRAIL_GROUP_COUNTS_GLSL

#include "target.glsl"

#if VITRAIL_NETWORKS
shared uint groupLayersMax;
shared uint groupCovered;
shared uint groupApproximate;

void beginCounts() {
  if (gl_LocalInvocationIndex == 0u) {
    groupLayersMax = 0u;
    groupCovered = 0u;
    groupApproximate = 0u;
  }
  barrier();
}

// A pixel with a list, of which `layers` fragments were walked.
void countPixel(uint layers) {
  atomicMax(groupLayersMax, layers);
  atomicAdd(groupCovered, 1u);
  if (kMaxLayers != 0u && layers > kMaxLayers) atomicAdd(groupApproximate, 1u);
}

void endCounts() {
  barrier();
  if (gl_LocalInvocationIndex != 0u || groupCovered == 0u) return;
  countLayers(groupLayersMax);
  atomicAdd(vitrailControl.coveredPixels[(gl_WorkGroupID.x + gl_WorkGroupID.y) % VITRAIL_COUNTERS], groupCovered);
  if (groupApproximate > 0u) atomicAdd(vitrailControl.approximatePixels, groupApproximate);
}
#else
void beginCounts() {}

void countPixel(uint layers) {
  countLayers(layers);
  atomicAdd(vitrailControl.coveredPixels[(gl_WorkGroupID.x + gl_WorkGroupID.y) % VITRAIL_COUNTERS], 1u);
  if (kMaxLayers != 0u && layers > kMaxLayers) atomicAdd(vitrailControl.approximatePixels, 1u);
}

void endCounts() {}
#endif

#endif
