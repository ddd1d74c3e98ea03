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

// Defines a function that leaves a pixel to a later dispatch. A macro, because memory that atomics change cannot be a
// parameter. More pixels than `pixels` holds are more than the pool's nodes can make lists for: those are corrupt.
#define LEAVE(name, pixels, lists, groupsX, groupsY, groupsZ) \
  void name(uint pixelIndex) { \
    uint slot = atomicAdd(control.lists, 1u); \
    if (slot >= uint(pixels.length())) { \
      atomicAdd(control.cutPixels, 1u); \
      return; \
    } \
    pixels[slot] = pixelIndex; \
    uvec3 groups; \
    if (!opensGroup(slot, groups)) return; \
    atomicMax(control.groupsX, groups.x); \
    atomicMax(control.groupsY, groups.y); \
    atomicMax(control.groupsZ, groups.z); \
  }
LEAVE(leaveMedium, mediumPixels, mediumLists, mediumGroupsX, mediumGroupsY, mediumGroupsZ)
LEAVE(leaveLong, longPixels, longLists, longGroupsX, longGroupsY, longGroupsZ)
#undef LEAVE

// After the short lists: by networks the next class, else the last one.
void leaveForLater(uint pixelIndex) {
#if VITRAIL_NETWORKS
  leaveMedium(pixelIndex);
#else
  leaveLong(pixelIndex);
#endif
}

#endif
