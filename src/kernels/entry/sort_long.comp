// Before a fragment resolve or one of the host's: sorts the lists that sort_find.comp found, where they lie, with
// VITRAIL_SORT_WORDS those that are alike by their words. One thread a list.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "target.glsl"

#ifdef VITRAIL_SORT_WORDS
uint vitrailWordOf(uint index) {
  return vitrailParameters.userWords != 0u ? vitrailLoadWord(index, vitrailNodes()) : 0u;
}
#endif

#include "list/deep.glsl"
#include "list/walk.glsl"
#include "sink/samples.glsl"
#include "sink/blend.glsl"
#include "list/long.glsl"

layout(local_size_x = 32) in; // LONG_GROUP_LISTS

void main() {
  uint slot = deepGroup() * LONG_GROUP_LISTS + gl_LocalInvocationIndex;
  if (slot >= min(vitrailControl.classes[VITRAIL_CLASS_LONG].count, longPixels.length())) return;
  uint pixelIndex = longPixels[slot];
  VitrailSorted sorted = vitrailSortLong(vitrailHeads[pixelIndex], nodesInUse());
  vitrailHeads[pixelIndex] = sorted.head;
  countLayers(sorted.count);
  if (kMaxLayers != 0u && sorted.count > kMaxLayers) atomicAdd(vitrailControl.approximatePixels, 1u);
  if (!sorted.complete) atomicAdd(vitrailControl.cutPixels, 1u);
}
