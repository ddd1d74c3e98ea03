// The third and the fourth dispatch of the compute resolve, by networks: groups of 4 invocations take lists of up to 64
// fragments, groups of 8 those of up to 128, and one of them a longer one.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_GROUPS
#include "picture.glsl"
#include "vitrail/resolve_group.glsl"
#include "vitrail/resolve_long.glsl"

layout(local_size_x = 128) in; // kGroup times LONG_GROUP_LISTS or LONGEST_GROUP_LISTS

// Whether the invocations of a group can exchange what they have: implementations place them in subgroups at will. All
// of the group, or none. No && round what all must execute.
bool isGroup() {
  uint found = 1u;
  for (uint mask = 1u; mask < kGroup; mask *= 2u) {
    uint other = subgroupShuffleXor(gl_LocalInvocationIndex, mask);
    found &= uint(other == (gl_LocalInvocationIndex ^ mask));
  }
  for (uint mask = 1u; mask < kGroup; mask *= 2u) found &= subgroupShuffleXor(found, mask);
  return found != 0u;
}

// Lists of this dispatch.
uint groupLists() {
  if (kGroup == 4u) return min(control.classes[VITRAIL_CLASS_LONG].count, longLists.length());
  return min(control.classes[VITRAIL_CLASS_LONGEST].count, longLists.length() / 2u);
}

// A word of a list: 0 is its pixel, the others are where its second part begins and those after it.
uint listWord(uint slot, uint word) {
  if (kGroup == 4u) return longLists[slot][word];
  return longLists[longestElement(slot) + word / 4u][word % 4u];
}

void main() {
  uint slot = deepGroup() * (gl_WorkGroupSize.x / kGroup) + gl_LocalInvocationIndex / kGroup;
  if (slot >= groupLists()) return;
  uint lane = gl_LocalInvocationIndex % kGroup;
  uint pixelIndex = listWord(slot, 0u);
  if (pixelIndex >= parameters.width * parameters.height) return; // what a corrupt list left
  beginPixel(imagePixel(pixelIndex));
  uint start = lane == 0u ? heads[pixelIndex] : listWord(slot, lane);
  VitrailResolved r;
  r.complete = false;
  if (isGroup()) r = vitrailResolveGroup(lane, kGroup, start, nodesInUse());
  if (lane != 0u) return;
  if (!r.complete) {
    r = vitrailResolveLong(start, nodesInUse());
    heads[pixelIndex] = start;
  }
  writeDeepPixel(pixelIndex, r);
}
