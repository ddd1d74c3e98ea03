// The lists of pixels that a dispatch leaves to the next one, which is dispatched indirectly. Compute shaders only.
#ifndef VITRAIL_DEEP_LISTS_GLSL
#define VITRAIL_DEEP_LISTS_GLSL

#include "target.glsl"

layout(set = 0, binding = 5, std430) buffer MediumListsBlock { uint mediumPixels[]; }; // control.mediumLists of them
layout(set = 0, binding = 6, std430) buffer LongListsBlock { uint longPixels[]; };     // control.longLists of them

// The work groups of those dispatches in a row: the least that maxComputeWorkGroupCount may be, rounded down.
const uint GROUPS_IN_ROW = 32768u;
const uint DEEP_GROUP_SIZE = 128u;

// The number of this invocation in a dispatch over a list of pixels.
uint deepSlot() {
  return (gl_WorkGroupID.y * GROUPS_IN_ROW + gl_WorkGroupID.x) * DEEP_GROUP_SIZE + gl_LocalInvocationIndex;
}

// Whether the slot is the first of a work group, which then makes the dispatch large enough.
bool opensGroup(uint slot, out uvec3 groups) {
  uint group = slot / DEEP_GROUP_SIZE;
  groups = uvec3(min(group + 1u, GROUPS_IN_ROW), group / GROUPS_IN_ROW + 1u, 1u);
  return slot % DEEP_GROUP_SIZE == 0u;
}

void leaveLong(uint pixelIndex) {
  uint slot = atomicAdd(control.longLists, 1u);
  if (slot >= uint(longPixels.length())) { // more long lists than the pool's nodes can make: they are corrupt
    atomicAdd(control.cutPixels, 1u);
    return;
  }
  longPixels[slot] = pixelIndex;
  uvec3 groups;
  if (!opensGroup(slot, groups)) return;
  atomicMax(control.longGroupsX, groups.x);
  atomicMax(control.longGroupsY, groups.y);
  atomicMax(control.longGroupsZ, groups.z);
}

void leaveMedium(uint pixelIndex) {
  uint slot = atomicAdd(control.mediumLists, 1u);
  if (slot >= uint(mediumPixels.length())) {
    atomicAdd(control.cutPixels, 1u);
    return;
  }
  mediumPixels[slot] = pixelIndex;
  uvec3 groups;
  if (!opensGroup(slot, groups)) return;
  atomicMax(control.mediumGroupsX, groups.x);
  atomicMax(control.mediumGroupsY, groups.y);
  atomicMax(control.mediumGroupsZ, groups.z);
}

// After the short lists: by networks the next class, else the last one.
void leaveForLater(uint pixelIndex) {
#if VITRAIL_NETWORKS
  leaveMedium(pixelIndex);
#else
  leaveLong(pixelIndex);
#endif
}

#endif
