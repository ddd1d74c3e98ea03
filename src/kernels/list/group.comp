// The classes of long lists, the third and the fourth dispatch of the compute resolve: a group of neighbouring
// invocations of a subgroup sorts a list, up to 16 fragments for each; 4 take lists of up to 64 fragments, 8 those of
// up to 128, and one of them a longer one. Every one follows its part of the list and sorts it in registers; the parts
// are merged by exchanging keys between invocations (Batcher's bitonic merging; Knuth, The Art of Computer Programming,
// volume 3, 5.3.4), and every one hands its part to a sink of its own, which are joined.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_shuffle : require
#define VITRAIL_GROUPS
#include "sink/picture.glsl"
#include "sink/blend_group.glsl"
#include "list/long.glsl"

layout(local_size_x = 128) in; // kGroup times LONG_GROUP_LISTS or LONGEST_GROUP_LISTS

// Words of a key that can differ; the others are 0.
uint vitrailKeyWords() {
  VitrailLayout nodes = vitrailNodes();
  if (nodes.format == VITRAIL_FORMAT_COMPACT) return 2u;
  return (nodes.format == VITRAIL_FORMAT_HDR ? 3u : 2u) + (nodes.samples > 1u ? 1u : 0u);
}

// The key that the invocation `mask` away has.
uvec4 vitrailKeyOf(uvec4 key, uint mask) {
  uvec4 other = uvec4(subgroupShuffleXor(key.x, mask), subgroupShuffleXor(key.y, mask), 0u, 0u);
  if (vitrailKeyWords() > 2u) other.z = subgroupShuffleXor(key.z, mask);
  if (vitrailKeyWords() > 3u) other.w = subgroupShuffleXor(key.w, mask);
  return other;
}

// Keeps the nearer of two keys, or the farther one.
void vitrailKeep(inout uvec4 key, uvec4 other, bool nearer) {
  if (vitrailBefore(other, key) == nearer) key = other;
}

// Compares with the invocation `mask` away, entry by entry, or the first entry with its last and so on.
void vitrailCompare(inout VitrailEntry e[16], uint mask, bool nearer) {
#define VITRAIL_KEEP(i) vitrailKeep(e[i].key, vitrailKeyOf(e[i].key, mask), nearer);
  VITRAIL_KEEP(0) VITRAIL_KEEP(1) VITRAIL_KEEP(2) VITRAIL_KEEP(3) VITRAIL_KEEP(4) VITRAIL_KEEP(5) VITRAIL_KEEP(6)
  VITRAIL_KEEP(7) VITRAIL_KEEP(8) VITRAIL_KEEP(9) VITRAIL_KEEP(10) VITRAIL_KEEP(11) VITRAIL_KEEP(12) VITRAIL_KEEP(13)
  VITRAIL_KEEP(14) VITRAIL_KEEP(15)
}

void vitrailCompareMirrored(inout VitrailEntry e[16], uint mask, bool nearer) {
  uvec4 last;
  uvec4 first;
#define VITRAIL_KEEP_MIRRORED(i, j) \
  last = vitrailKeyOf(e[j].key, mask); \
  first = vitrailKeyOf(e[i].key, mask); \
  vitrailKeep(e[i].key, last, nearer); \
  vitrailKeep(e[j].key, first, nearer);
  VITRAIL_KEEP_MIRRORED(0, 15) VITRAIL_KEEP_MIRRORED(1, 14) VITRAIL_KEEP_MIRRORED(2, 13) VITRAIL_KEEP_MIRRORED(3, 12)
  VITRAIL_KEEP_MIRRORED(4, 11) VITRAIL_KEEP_MIRRORED(5, 10) VITRAIL_KEEP_MIRRORED(6, 9) VITRAIL_KEEP_MIRRORED(7, 8)
}

// Sorts entries that ascend and then descend, or the other way round.
void vitrailMergeBitonic(inout VitrailEntry e[16]) {
#define VITRAIL_STEPS_2(i) VITRAIL_X(i, i + 2) VITRAIL_X(i + 1, i + 3) VITRAIL_X(i, i + 1) VITRAIL_X(i + 2, i + 3)
#define VITRAIL_STEPS_4(i) \
  VITRAIL_X(i, i + 4) VITRAIL_X(i + 1, i + 5) VITRAIL_X(i + 2, i + 6) VITRAIL_X(i + 3, i + 7) \
  VITRAIL_STEPS_2(i) VITRAIL_STEPS_2(i + 4)
  VITRAIL_X(0, 8) VITRAIL_X(1, 9) VITRAIL_X(2, 10) VITRAIL_X(3, 11)
  VITRAIL_X(4, 12) VITRAIL_X(5, 13) VITRAIL_X(6, 14) VITRAIL_X(7, 15)
  VITRAIL_STEPS_4(0) VITRAIL_STEPS_4(8)
}

// Merges the entries of `width` invocations, of which both halves lie sorted.
void vitrailMergeLanes(inout VitrailEntry e[16], uint lane, uint width) {
  vitrailCompareMirrored(e, width - 1u, (lane & width >> 1) == 0u);
  for (uint mask = width >> 2; mask > 0u; mask >>= 1) vitrailCompare(e, mask, (lane & mask) == 0u);
  vitrailMergeBitonic(e);
}

// Called by all `lanes` invocations of a group (2, 4 or 8), each with its number, from 0, and where its part of the
// list begins (list/parts.glsl). All return the result. A longer list is not complete.
VitrailSink vitrailGroup(uint lane, uint lanes, uint start, uint nodeCount) {
  VitrailWalk walk = VitrailWalk(start, 0u, nodeCount);
  VitrailEntry e[16] = VitrailEntry[16](VITRAIL_LAST_16);
  VITRAIL_TAKE_16
  bool more = vitrailMore(walk) && lane == lanes - 1u; // what follows the other parts is the next part
  VITRAIL_NETWORK_16
  for (uint width = 2u; width <= lanes; width *= 2u) vitrailMergeLanes(e, lane, width);

  VitrailSink sink = vitrailBegin();
  uint number = lane * VITRAIL_SHORT_LIST;
#define VITRAIL_PUT_PART(i) if (e[i].key.x != 0xffffffffu) vitrailPut(sink, e[i], number + i);
  VITRAIL_PUT_PART(0) VITRAIL_PUT_PART(1) VITRAIL_PUT_PART(2) VITRAIL_PUT_PART(3) VITRAIL_PUT_PART(4)
  VITRAIL_PUT_PART(5) VITRAIL_PUT_PART(6) VITRAIL_PUT_PART(7) VITRAIL_PUT_PART(8) VITRAIL_PUT_PART(9)
  VITRAIL_PUT_PART(10) VITRAIL_PUT_PART(11) VITRAIL_PUT_PART(12) VITRAIL_PUT_PART(13) VITRAIL_PUT_PART(14)
  VITRAIL_PUT_PART(15)
  sink.layers = walk.count;
  sink.complete = !more;
  for (uint mask = 1u; mask < lanes; mask *= 2u) vitrailJoinLanes(sink, lane, mask);
  vitrailEnd(sink);
  return sink;
}

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
  if (kGroup == 4u) return min(vitrailControl.classes[VITRAIL_CLASS_LONG].count, longLists.length());
  return min(vitrailControl.classes[VITRAIL_CLASS_LONGEST].count, longLists.length() / 2u);
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
  if (pixelIndex >= vitrailParameters.width * vitrailParameters.height) return; // what a corrupt list left
  beginPixel(imagePixel(pixelIndex));
  uint start = lane == 0u ? vitrailHeads[pixelIndex] : listWord(slot, lane);
  VitrailSink r;
  r.complete = false;
  if (isGroup()) r = vitrailGroup(lane, kGroup, start, nodesInUse());
  if (lane != 0u) return;
  if (!r.complete) {
    r = vitrailLong(start, nodesInUse());
    vitrailHeads[pixelIndex] = start;
  }
  writeDeepPixel(pixelIndex, r);
}
