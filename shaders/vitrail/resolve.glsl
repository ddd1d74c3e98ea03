// Walks one fragment list, sorts it in registers and blends it front to back. No bindings: the including shader
// defines, before the include,
//
//   VITRAIL_ACCUMULATORS              1, or 8 where one invocation blends all samples of a pixel
//   VitrailLayout vitrailNodes()      how the nodes are stored; constants, so that what is not needed falls away
//   uvec4 vitrailLoadNode(uint index, VitrailLayout nodes)             pool.glsl has it
//   uint vitrailVisible(uvec4 key)    the samples that a fragment adds to, one bit each; bit 0 with one accumulator
//   uint vitrailMaxLayers()           VitrailVkTargetDesc::maxLayers
//   VITRAIL_NETWORKS                  1: sorting networks, 0: insertion (sort.glsl says which suits what)
//
// Lists that are longer than the registers take are left to another kernel: one for every length would make the many
// short lists pay, in registers and in code, for the few long ones.
#ifndef VITRAIL_RESOLVE_GLSL
#define VITRAIL_RESOLVE_GLSL

#include "node.glsl"
#include "sort.glsl"
#include "sums.glsl"

struct VitrailResolved {
  VitrailPair pairs[VITRAIL_ACCUMULATORS]; // what the list does to each sample
  VitrailSums tails[VITRAIL_ACCUMULATORS]; // fragments beyond maxLayers; unused without it
  uint layers;                             // fragments in the list
  bool complete;                           // false: there is more in the list than was blended
};

#if VITRAIL_ACCUMULATORS == 1
#define VITRAIL_EACH_SAMPLE(what) what(0)
#else
#define VITRAIL_EACH_SAMPLE(what) what(0) what(1) what(2) what(3) what(4) what(5) what(6) what(7)
#endif

VitrailResolved vitrailNothing() {
  VitrailResolved result;
#define VITRAIL_CLEAR(s) \
  result.pairs[s] = VitrailPair(vec3(0.0), vec4(1.0)); \
  result.tails[s] = VITRAIL_NO_SUMS;
  VITRAIL_EACH_SAMPLE(VITRAIL_CLEAR)
  result.layers = 0u;
  result.complete = true;
  return result;
}

// What a walk needs to know: nodes at or beyond `nodeCount` do not exist, and no list is longer, so a corrupt one ends.
struct VitrailWalk {
  uint index; // the next node
  uint count; // nodes walked so far
  uint nodeCount;
};

bool vitrailMore(VitrailWalk walk) { return max(walk.index, walk.count) < walk.nodeCount; }

// The entry of the next node, which it steps over; past the end one behind all others.
VitrailEntry vitrailTake(inout VitrailWalk walk) {
  VitrailEntry entry = VITRAIL_LAST;
  if (!vitrailMore(walk)) return entry;
  uvec4 node = vitrailLoadNode(walk.index, vitrailNodes());
  entry.key = vitrailKey(node, vitrailNodes());
  entry.index = walk.index;
  walk.index = node.w & vitrailNextMask(vitrailNodes());
  ++walk.count;
  return entry;
}

void vitrailCompose(inout VitrailPair front, VitrailPair behind) {
  front.color += front.transmittance.rgb * behind.color;
  front.transmittance *= behind.transmittance;
}

// Puts a fragment behind what is there.
void vitrailBlend(inout VitrailResolved result, uvec4 key) {
  VitrailPair pair = vitrailPairOf(key, vitrailNodes());
  uint visible = vitrailVisible(key);
#define VITRAIL_COMPOSE(s) if ((visible & (1u << s)) != 0u) vitrailCompose(result.pairs[s], pair);
  VITRAIL_EACH_SAMPLE(VITRAIL_COMPOSE)
}

// Adds a fragment to the tail, whose order does not matter.
void vitrailAddTail(inout VitrailResolved result, uvec4 key) {
  VitrailSums sums = vitrailSumsOf(key, vitrailNodes(), 1.0);
  uint visible = vitrailVisible(key);
#define VITRAIL_ADD(s) if ((visible & (1u << s)) != 0u) vitrailAddSums(result.tails[s], sums);
  VITRAIL_EACH_SAMPLE(VITRAIL_ADD)
}

// Puts the tail behind what is there.
void vitrailBlendTail(inout VitrailResolved result) {
#define VITRAIL_BLEND_TAIL(s) vitrailCompose(result.pairs[s], vitrailPairOfSums(result.tails[s]));
  VITRAIL_EACH_SAMPLE(VITRAIL_BLEND_TAIL)
}

// The next fragment in order, the `number`-th from 0.
void vitrailBlendSorted(inout VitrailResolved result, uvec4 key, uint number) {
  if (vitrailMaxLayers() == 0u || number < vitrailMaxLayers()) {
    vitrailBlend(result, key);
  } else {
    vitrailAddTail(result, key);
  }
}

// Whether nothing farther away can change a bit of the result, for colours up to the largest 16-bit float.
bool vitrailIsOpaque(VitrailResolved result) {
  bool opaque = true;
#define VITRAIL_IS_OPAQUE(s) \
  opaque = opaque && result.pairs[s].transmittance.a < 2.98e-8 && \
           fma(result.pairs[s].transmittance.rgb, vec3(65504.0), result.pairs[s].color) == result.pairs[s].color;
  VITRAIL_EACH_SAMPLE(VITRAIL_IS_OPAQUE)
  return opaque;
}

#define VITRAIL_TAKE(i) e[i] = vitrailTake(walk);
#define VITRAIL_BLEND(i) if (walk.count > i) vitrailBlendSorted(result, e[i].key, i);

// The next 16 fragments of a list.
#define VITRAIL_TAKE_16 \
  VITRAIL_TAKE(0) VITRAIL_TAKE(1) VITRAIL_TAKE(2) VITRAIL_TAKE(3) \
  if (vitrailMore(walk)) { \
    VITRAIL_TAKE(4) VITRAIL_TAKE(5) VITRAIL_TAKE(6) VITRAIL_TAKE(7) \
  } \
  if (vitrailMore(walk)) { \
    VITRAIL_TAKE(8) VITRAIL_TAKE(9) VITRAIL_TAKE(10) VITRAIL_TAKE(11) \
    VITRAIL_TAKE(12) VITRAIL_TAKE(13) VITRAIL_TAKE(14) VITRAIL_TAKE(15) \
  }

// The first 16 fragments of a list, sorted.
void vitrailSortFirst(inout VitrailWalk walk, inout VitrailEntry e[16]) {
#if VITRAIL_NETWORKS
  VITRAIL_TAKE_16
  vitrailSort(e, walk.count);
#else
  while (vitrailMore(walk) && walk.count < VITRAIL_SHORT_LIST) vitrailInsert(e, vitrailTake(walk));
#endif
}

// A list of at most 16 fragments, from its head; a longer one is not complete, and `walk` stands at what is left.
VitrailResolved vitrailResolveShort(inout VitrailWalk walk) {
  VitrailEntry e[16] = VitrailEntry[16](VITRAIL_LAST_16);
  vitrailSortFirst(walk, e);
  VitrailResolved result = vitrailNothing();
  result.layers = walk.count;
  result.complete = !vitrailMore(walk);
  if (!result.complete) return result;
#if VITRAIL_NETWORKS
  VITRAIL_BLEND(0) VITRAIL_BLEND(1) VITRAIL_BLEND(2) VITRAIL_BLEND(3)
  if (walk.count > 4u) {
    VITRAIL_BLEND(4) VITRAIL_BLEND(5) VITRAIL_BLEND(6) VITRAIL_BLEND(7)
  }
  if (walk.count > 8u) {
    VITRAIL_BLEND(8) VITRAIL_BLEND(9) VITRAIL_BLEND(10) VITRAIL_BLEND(11)
    VITRAIL_BLEND(12) VITRAIL_BLEND(13) VITRAIL_BLEND(14) VITRAIL_BLEND(15)
  }
#else
  for (uint number = 0u; number < walk.count; ++number) {
    vitrailBlendSorted(result, e[0].key, number);
    vitrailShift(e);
  }
#endif
  return result;
}

// A list of any length, of which the nearest maxLayers (at most 16) fragments are blended in order and the others
// approximately. The nearest stand at the end of the registers, so that what falls out is always the farthest.
VitrailResolved vitrailResolveCapped(uint head, uint nodeCount) {
  VitrailWalk walk = VitrailWalk(head, 0u, nodeCount);
  VitrailEntry e[16] = VitrailEntry[16](VITRAIL_LAST_16);
  VitrailEntry first = VitrailEntry(uvec4(0u), 0xffffffffu); // before every fragment: none has an empty key
  for (uint i = vitrailMaxLayers(); i < 16u; ++i) vitrailInsert(e, first);
  VitrailResolved result = vitrailNothing();
  while (vitrailMore(walk)) {
    VitrailEntry farthest = vitrailInsert(e, vitrailTake(walk));
    if (farthest.key.x != 0xffffffffu) vitrailAddTail(result, farthest.key);
  }
  for (int i = 0; i < 16; ++i) {
    if (e[0].key != uvec4(0u) && e[0].key.x != 0xffffffffu) vitrailBlend(result, e[0].key);
    vitrailShift(e);
  }
  vitrailBlendTail(result);
  result.layers = walk.count;
  return result;
}

#if VITRAIL_NETWORKS
// A list of at most 32 fragments; a longer one is not complete. By networks only.
VitrailResolved vitrailResolveMedium(uint head, uint nodeCount) {
  VitrailWalk walk = VitrailWalk(head, 0u, nodeCount);
  VitrailEntry e[32] = VitrailEntry[32](VITRAIL_LAST_16, VITRAIL_LAST_16);
  VITRAIL_TAKE(0) VITRAIL_TAKE(1) VITRAIL_TAKE(2) VITRAIL_TAKE(3)
  VITRAIL_TAKE(4) VITRAIL_TAKE(5) VITRAIL_TAKE(6) VITRAIL_TAKE(7)
  VITRAIL_TAKE(8) VITRAIL_TAKE(9) VITRAIL_TAKE(10) VITRAIL_TAKE(11)
  VITRAIL_TAKE(12) VITRAIL_TAKE(13) VITRAIL_TAKE(14) VITRAIL_TAKE(15)
  VITRAIL_TAKE(16) VITRAIL_TAKE(17) VITRAIL_TAKE(18) VITRAIL_TAKE(19)
  if (vitrailMore(walk)) {
    VITRAIL_TAKE(20) VITRAIL_TAKE(21) VITRAIL_TAKE(22) VITRAIL_TAKE(23)
    VITRAIL_TAKE(24) VITRAIL_TAKE(25) VITRAIL_TAKE(26) VITRAIL_TAKE(27)
    VITRAIL_TAKE(28) VITRAIL_TAKE(29) VITRAIL_TAKE(30) VITRAIL_TAKE(31)
  }
  VitrailResolved result = vitrailNothing();
  result.layers = walk.count;
  result.complete = !vitrailMore(walk);
  if (!result.complete) return result;
  vitrailSort(e);
  VITRAIL_BLEND(0) VITRAIL_BLEND(1) VITRAIL_BLEND(2) VITRAIL_BLEND(3)
  VITRAIL_BLEND(4) VITRAIL_BLEND(5) VITRAIL_BLEND(6) VITRAIL_BLEND(7)
  VITRAIL_BLEND(8) VITRAIL_BLEND(9) VITRAIL_BLEND(10) VITRAIL_BLEND(11)
  VITRAIL_BLEND(12) VITRAIL_BLEND(13) VITRAIL_BLEND(14) VITRAIL_BLEND(15)
  VITRAIL_BLEND(16) VITRAIL_BLEND(17) VITRAIL_BLEND(18) VITRAIL_BLEND(19)
  if (walk.count > 20u) {
    VITRAIL_BLEND(20) VITRAIL_BLEND(21) VITRAIL_BLEND(22) VITRAIL_BLEND(23)
    VITRAIL_BLEND(24) VITRAIL_BLEND(25) VITRAIL_BLEND(26) VITRAIL_BLEND(27)
    VITRAIL_BLEND(28) VITRAIL_BLEND(29) VITRAIL_BLEND(30) VITRAIL_BLEND(31)
  }
  if (vitrailMaxLayers() != 0u) vitrailBlendTail(result);
  return result;
}
#endif

// All of a list by sums alone, `missing` included: fragments of this pixel that found no node.
VitrailResolved vitrailResolveSums(uint head, uint nodeCount, VitrailSums missing) {
  VitrailWalk walk = VitrailWalk(head, 0u, nodeCount);
  while (vitrailMore(walk)) {
    uvec4 key = vitrailTake(walk).key;
    float weight = float(bitCount(vitrailKeyCoverage(key, vitrailNodes()))) / float(vitrailNodes().samples);
    vitrailAddSums(missing, vitrailMergeFilters(vitrailSumsOf(key, vitrailNodes(), weight)));
  }
  VitrailResolved result = vitrailNothing();
  VitrailPair pair = vitrailPairOfSums(missing);
#define VITRAIL_SET_PAIR(s) result.pairs[s] = pair;
  VITRAIL_EACH_SAMPLE(VITRAIL_SET_PAIR)
  result.layers = walk.count;
  return result;
}

#endif
