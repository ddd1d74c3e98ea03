// What every kernel binds of a target, and how it is specialized. With VITRAIL_NETWORKS set to 1 it sorts as suits a
// GPU (list/networks.glsl), with 0 as suits a CPU (vitrail/sort.glsl). The set is the one that collecting shaders bind,
// with the lists of deep pixels (list/deep.glsl) beside it.
#ifndef VITRAIL_KERNEL_TARGET_GLSL
#define VITRAIL_KERNEL_TARGET_GLSL

#define VITRAIL_SET 0
#include "vitrail/target.glsl"

#ifndef VITRAIL_IS_FORMAT
VITRAIL_SPECIALIZED(0) const uint kFormat = VITRAIL_FORMAT_STANDARD;
VITRAIL_SPECIALIZED(1) const uint kSamples = 1u;
VITRAIL_SPECIALIZED(2) const bool kNearestIsOne = false;
VITRAIL_SPECIALIZED(3) const uint kMaxLayers = 0u;
VITRAIL_SPECIALIZED(4) const bool kTestDepth = false; // coverage has not passed the depth test
VITRAIL_SPECIALIZED(5) const uint kGroup = 4u;        // list/group.comp: invocations that share a list, 4 or 8
#else // GLSL for OpenGL, which has no such constants: the library defines them
const uint kFormat = VITRAIL_IS_FORMAT;
const uint kSamples = VITRAIL_IS_SAMPLES;
const bool kNearestIsOne = VITRAIL_IS_NEAREST_ONE;
const uint kMaxLayers = VITRAIL_IS_MAX_LAYERS;
const bool kTestDepth = VITRAIL_IS_TEST_DEPTH;
const uint kGroup = VITRAIL_IS_GROUP;
#endif

// Lists need no sorting where only their nearest fragments are kept.
const bool kCapped = kMaxLayers != 0u && kMaxLayers <= VITRAIL_SHORT_LIST;

layout(VITRAIL_BOUND(0, VITRAIL_BINDING_SUMS), std430) buffer SumsBlock { uint pixelSums[]; };

VitrailLayout vitrailNodes() { return VitrailLayout(kFormat, kSamples, kNearestIsOne); }
uint vitrailMaxLayers() { return kMaxLayers; }

// Pixels of the frame's area, from its corner.
bool isInArea(uvec2 local) { return local.x < vitrailParameters.width && local.y < vitrailParameters.height; }
uint pixelIndexOf(uvec2 local) { return local.y * vitrailParameters.width + local.x; }

// The most fragments of a pixel. Atomics on one word wait for each other; most pixels are not deeper and need none. One
// that sees an earlier maximum makes one atomic too many.
void countLayers(uint layers) {
  if (layers > vitrailControl.layersMax) atomicMax(vitrailControl.layersMax, layers);
}

uint nodesInUse() { return min(vitrailControl.requested, vitrailParameters.capacity); }
bool overflowed() {
  return vitrailControl.requested > vitrailParameters.capacity ||
         (vitrailControl.misfits | vitrailControl.misfitNodes) != 0u;
}

#endif
