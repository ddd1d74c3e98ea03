// A producer: where the fragments of a pixel come from. A class of lists (short.glsl, medium.glsl and so on) asks for
//
//   VitrailWalk                                    what stands between two fragments; `count` of them were taken
//   bool vitrailMore(VitrailWalk walk)             whether there is another
//   VitrailEntry vitrailTake(inout VitrailWalk)    it, in any order; past the end one behind all others
//
// and this is the node pool as a producer: a walk begins at a head pointer. Another producer is another file with these
// three. Classes that relink lists (long.glsl), or divide them (parts.glsl), are for the pool only.
//
// Before the include, a shader defines
//
//   VitrailLayout vitrailNodes()   how the nodes are stored; constants, so that what is not needed falls away
//   uvec4 vitrailLoadNode(uint index, VitrailLayout nodes)   vitrail/pool.glsl has it
//   uint vitrailWordOf(uint index)                           with VITRAIL_SORT_WORDS: the host's word of a node
#ifndef VITRAIL_WALK_GLSL
#define VITRAIL_WALK_GLSL

#include "vitrail/node.glsl"
#include "vitrail/sort.glsl"

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
#ifdef VITRAIL_SORT_WORDS
  entry.word = vitrailWordOf(walk.index);
#endif
  walk.index = node.w & vitrailNextMask(vitrailNodes());
  ++walk.count;
  return entry;
}

#endif
