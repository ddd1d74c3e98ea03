// Walks one fragment list, sorts it in registers and blends it front to back. A list that is longer than the registers
// take is left to resolve_long.glsl. No bindings: the including shader defines, before the include,
//
//   VitrailNode vitrailLoadNode(uint index);
//
// The code is small on purpose. A CPU driver that runs both sides of every branch pays for each line, and a GPU for each
// register: one kernel for every length would make the many short lists pay for the few long ones.
#ifndef VITRAIL_RESOLVE_GLSL
#define VITRAIL_RESOLVE_GLSL

#include "node.glsl"
#include "sort.glsl"

struct VitrailResolved {
  vec3 color;          // what the list adds, premultiplied
  float transmittance; // what is left of the light from behind it
  uint layers;         // fragments in the list
  bool complete;       // false: there is more in the list than was blended
};

// What a walk needs to know: nodes at or beyond `nodeCount` do not exist, and no list is longer, so a corrupt one ends.
struct VitrailWalk {
  uint index; // the next node
  uint count; // nodes walked so far
  uint nodeCount;
  bool nearestIsOne;
};

bool vitrailMore(VitrailWalk walk) { return walk.index < walk.nodeCount && walk.count < walk.nodeCount; }

uvec2 vitrailKey(VitrailNode node, bool nearestIsOne) {
  return uvec2(vitrailDepthKey(node.depth, nearestIsOne), node.color);
}

// The key of the next node, which it steps over; past the end a key behind all others.
void vitrailTake(inout VitrailWalk walk, out uvec2 key) {
  key = VITRAIL_LAST_KEY;
  if (!vitrailMore(walk)) return;
  VitrailNode node = vitrailLoadNode(walk.index);
  key = vitrailKey(node, walk.nearestIsOne);
  walk.index = node.next;
  ++walk.count;
}

void vitrailBlend(inout VitrailResolved result, uint colorBits) {
  vec4 c = vitrailUnpackColor(colorBits);
  result.color += result.transmittance * c.a * c.rgb;
  result.transmittance *= 1.0 - c.a;
}

// `head` is the first node, `nodeCount` the nodes that are in use. A list of more than VITRAIL_BLOCK fragments is not
// complete and must be resolved by vitrailResolveLong().
VitrailResolved vitrailResolveShort(uint head, uint nodeCount, bool nearestIsOne) {
  VitrailWalk walk = VitrailWalk(head, 0u, nodeCount, nearestIsOne);
  uvec2 k[16] = VITRAIL_LAST_KEYS;
  while (vitrailMore(walk) && walk.count < VITRAIL_BLOCK) {
    uvec2 key;
    vitrailTake(walk, key);
    vitrailInsert(k, key);
  }
  VitrailResolved result = VitrailResolved(vec3(0.0), 1.0, walk.count, !vitrailMore(walk));
  for (uint left = result.complete ? walk.count : 0u; left > 0u; --left) {
    vitrailBlend(result, k[0].y);
    vitrailShift(k);
  }
  return result;
}

#endif
