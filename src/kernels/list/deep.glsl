// The lists that a dispatch leaves to later ones, which are dispatched indirectly. Compute shaders only. With
// VITRAIL_GROUPS there are later dispatches for several lengths, else one for all.
#ifndef VITRAIL_DEEP_GLSL
#define VITRAIL_DEEP_GLSL

#include "target.glsl"
#include "list/parts.glsl"

#ifdef VITRAIL_GROUPS
// Lists that one invocation takes: the pixels of VITRAIL_CLASS_MEDIUM.
layout(VITRAIL_BOUND(0, VITRAIL_BINDING_MEDIUM_LISTS), std430) buffer MediumListsBlock { uint mediumPixels[]; };
// Lists that groups of invocations take: the pixel, and where the second part begins and those after it
// (list/parts.glsl). From the front VITRAIL_CLASS_LONG for groups of 4, one element each; from the end
// VITRAIL_CLASS_LONGEST for groups of 8, or of any length, two elements each. A pool has not the nodes for so many that
// they meet.
layout(VITRAIL_BOUND(0, VITRAIL_BINDING_LONG_LISTS), std430) buffer LongListsBlock { uvec4 longLists[]; };
#else
layout(VITRAIL_BOUND(0, VITRAIL_BINDING_LONG_LISTS), std430) buffer LongListsBlock { uint longPixels[]; };
#endif

// The work groups of those dispatches in a row: the least that maxComputeWorkGroupCount may be, rounded down.
const uint GROUPS_IN_ROW = 32768u;
// Lists of one work group of each dispatch.
const uint MEDIUM_GROUP_LISTS = 128u;
const uint LONG_GROUP_LISTS = 32u;
const uint LONGEST_GROUP_LISTS = 16u;

// The number of this work group in a dispatch over lists.
uint deepGroup() { return gl_WorkGroupID.y * GROUPS_IN_ROW + gl_WorkGroupID.x; }

// Takes a number for a list that is left to a later dispatch, and makes that one large enough.
uint classSlot(uint number, uint groupLists) {
  uint slot = atomicAdd(vitrailControl.classes[number].count, 1u);
  if (slot % groupLists == 0u) {
    uint group = slot / groupLists;
    atomicMax(vitrailControl.classes[number].groupsX, min(group + 1u, GROUPS_IN_ROW));
    atomicMax(vitrailControl.classes[number].groupsY, group / GROUPS_IN_ROW + 1u);
    atomicMax(vitrailControl.classes[number].groupsZ, 1u);
  }
  return slot;
}

// Whether there is room for a list. Where there is none, lists are corrupt: the pool has not the nodes for so many.
bool hasRoom(uint end, uint length) {
  if (end > length) atomicAdd(vitrailControl.cutPixels, 1u);
  return end <= length;
}

#ifdef VITRAIL_GROUPS
void leaveMedium(uint pixelIndex) {
  uint slot = classSlot(VITRAIL_CLASS_MEDIUM, MEDIUM_GROUP_LISTS);
  if (hasRoom(slot + 1u, mediumPixels.length())) mediumPixels[slot] = pixelIndex;
}

void leaveLong(uint pixelIndex, uvec3 near) {
  uint slot = classSlot(VITRAIL_CLASS_LONG, LONG_GROUP_LISTS);
  if (hasRoom(slot + 1u, longLists.length())) longLists[slot] = uvec4(pixelIndex, near);
}

// The first element of a list for groups of 8.
uint longestElement(uint slot) { return longLists.length() - 2u * (slot + 1u); }

void leaveLongest(uint pixelIndex, uvec3 near, uvec4 far) {
  uint slot = classSlot(VITRAIL_CLASS_LONGEST, LONGEST_GROUP_LISTS);
  if (!hasRoom(2u * (slot + 1u), longLists.length())) return;
  longLists[longestElement(slot)] = uvec4(pixelIndex, near);
  longLists[longestElement(slot) + 1u] = far;
}

// Leaves what `walk` has begun to follow to a later dispatch. Returns the fragments of the list, as far as it walks.
uint leaveForLater(uint pixelIndex, VitrailWalk walk) {
  VitrailParts parts = vitrailFindParts(walk);
  if (walk.count <= VITRAIL_MEDIUM_LIST) {
    leaveMedium(pixelIndex);
  } else if (walk.count <= VITRAIL_LONG_LIST) {
    leaveLong(pixelIndex, parts.near);
  } else {
    leaveLongest(pixelIndex, parts.near, parts.far);
  }
  return walk.count;
}
#else
uint leaveForLater(uint pixelIndex, VitrailWalk walk) {
  uint slot = classSlot(VITRAIL_CLASS_LONG, LONG_GROUP_LISTS);
  if (hasRoom(slot + 1u, longPixels.length())) longPixels[slot] = pixelIndex;
  return walk.count;
}
#endif

#endif
