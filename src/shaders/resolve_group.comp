// The third and the fourth dispatch of the compute resolve, by networks: groups of 4 invocations take lists of up to 64
// fragments, groups of 8 those of up to 128 and longer ones.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_GROUPS
#include "picture.glsl"
#include "vitrail/resolve_group.glsl"
#include "vitrail/resolve_long.glsl"
#ifdef VITRAIL_LONGEST
const uint LANES = 8u;
#else
const uint LANES = 4u;
#endif

layout(local_size_x = 128) in; // LANES * LONG_GROUP_LISTS, LANES * LONGEST_GROUP_LISTS

// Whether the invocations of a group can exchange what they have: implementations place them in subgroups at will.
bool isGroup() {
  bool found = true;
  for (uint mask = 1u; mask < LANES; mask *= 2u) {
    uint other = subgroupShuffleXor(gl_LocalInvocationIndex, mask);
    found = found && other == (gl_LocalInvocationIndex ^ mask);
  }
  return found;
}

void main() {
  uint slot = deepGroup() * (gl_WorkGroupSize.x / LANES) + gl_LocalInvocationIndex / LANES;
  uint lane = gl_LocalInvocationIndex % LANES;
#ifdef VITRAIL_LONGEST
  if (slot >= min(control.longestLists, longLists.length() / 2u)) return;
  uint first = longestElement(slot);
#else
  if (slot >= min(control.longLists, longLists.length())) return;
  uint first = slot;
#endif
  uint pixelIndex = longLists[first].x;
  if (pixelIndex >= parameters.width * parameters.height) return; // a corrupt list's
  beginPixel(imagePixel(pixelIndex));
  uint start = lane == 0u ? heads[pixelIndex] : longLists[first + lane / 4u][lane % 4u];
  VitrailResolved r;
  r.complete = false;
  if (isGroup()) r = vitrailResolveGroup(lane, LANES, start, nodesInUse());
  if (lane != 0u) return;
  if (!r.complete) r = vitrailResolveLong(start, nodesInUse());
  writeDeepPixel(pixelIndex, r);
}
