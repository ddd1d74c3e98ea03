// Before a fragment resolve: sorts the lists that sort_find.comp found, where they lie. One thread a list.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "deep_lists.glsl"

#define VITRAIL_ACCUMULATORS 1
uint vitrailVisible(uvec4 key) { return 1u; }
#include "vitrail/resolve_long.glsl"

layout(local_size_x = 32) in; // LONG_GROUP_LISTS

void main() {
  uint slot = deepGroup() * LONG_GROUP_LISTS + gl_LocalInvocationIndex;
  if (slot >= min(control.classes[VITRAIL_CLASS_LONG].count, longPixels.length())) return;
  uint pixelIndex = longPixels[slot];
  VitrailSorted sorted = vitrailSortLong(heads[pixelIndex], nodesInUse());
  heads[pixelIndex] = sorted.head;
  countLayers(sorted.count);
  if (kMaxLayers != 0u && sorted.count > kMaxLayers) atomicAdd(control.approximatePixels, 1u);
  if (!sorted.complete) atomicAdd(control.cutPixels, 1u);
}
