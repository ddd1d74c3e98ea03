// Walks the fragments of one pixel in order, nearest first, in a compute or fragment shader of the host's: what lies
// under a pixel, and whose it is. It only reads, so that any number of invocations may walk the same list.
//
//   #extension GL_GOOGLE_include_directive : require
//   #define VITRAIL_SET 0
//   #include "vitrail/list.glsl"
//   ...
//   VitrailList list = vitrailOpenList(pixel);
//   VitrailLayer layer;
//   while (vitrailNextLayer(list, layer)) {
//     ... layer.color, layer.depth, layer.blend, layer.coverage, layer.word; or vitrailPairOf(layer) (node.glsl):
//     color and transmittance, of what it does to the light d behind it: color + transmittance * d
//   }
//   if (vitrailListWasCut(list)) ... // there is more
//
// When: between vitrailVkCmdCollected() and the target's next vitrailVkCmdBegin(), before the resolve or after it. That
// call makes the lists visible to fragment and compute shaders. A resolve by compute relinks long lists: a shader that
// walks them after it waits for what it wrote (VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT), and
// the resolve waits for a shader that walked them before it (execution alone); both barriers are the host's. Lists are
// not walked while it runs.
//
// What: every fragment that vitrailCollect() stored, in order of depth; at the same depth in the order that
// the resolve blends them in (docs/resolve.md), and those that are alike in all that is stored by the host's word. Of a
// frame that overflowed (VitrailStats) it is what found a node.
//
// Cost: a walk of the list for every 16 fragments that are asked for, from its first one on. Two or three layers of any
// list are cheap, all layers of a list of n take n * n / 16 steps. Mesa's CPU driver ends the loops of an invocation
// after 65,535 turns; vitrailListWasCut() then says so, from lists of about 1,000 fragments on. With
// VITRAIL_SORTED_LISTS all layers of a list of n take n steps.
//
// Define before the include VITRAIL_SET, and VITRAIL_BUFFER_REFERENCE where the pool is to be reached by its address,
// as for vitrail/collect.glsl. It may stand beside that one in a shader. It takes three of the storage buffers
// that a stage may have. Define VITRAIL_SORTED_LISTS in shaders for targets with VITRAIL_RESOLVE_HOST, whose long lists
// vitrailVkCmdCollected() has sorted; of other targets such a shader walks them in no order.
#ifndef VITRAIL_LIST_GLSL
#define VITRAIL_LIST_GLSL

#define VITRAIL_SORT_WORDS
#include "sort.glsl"
#include "target.glsl"

// Whether the frame has fragments that found no node: lists lack them.
bool vitrailListsLackFragments() {
  return vitrailControl.requested > vitrailParameters.capacity ||
         (vitrailControl.misfits | vitrailControl.misfitNodes) != 0u;
}

struct VitrailList {
  VitrailLayout nodes;
  uint head; // where every walk begins
  uint nodeCount;
  VitrailEntry batch[16]; // the next fragments, in order,
  uint left;              // so many of them
  bool more;              // and those behind
#ifdef VITRAIL_SORTED_LISTS
  uint index; // of a list that lies sorted: the next node
  uint count; // nodes handed over
#else
  VitrailEntry last; // the one that was handed over last
#endif
};

VitrailEntry vitrailLoadEntry(uint index, VitrailLayout nodes, out uint next) {
  uvec4 node = vitrailLoadNode(index, nodes);
  VitrailEntry entry = VitrailEntry(vitrailKey(node, nodes), index, 0u);
  if (vitrailParameters.userWords != 0u) entry.word = vitrailLoadWord(index, nodes);
  next = node.w & vitrailNextMask(nodes);
  return entry;
}

#ifdef VITRAIL_SORTED_LISTS
// Sorts a list of at most 16 fragments. A longer one lies sorted.
void vitrailFirstBatch(inout VitrailList list) {
  uint index = list.head;
  uint length = 0u;
  while (index < list.nodeCount && length <= VITRAIL_SHORT_LIST) {
    index = vitrailLoadNext(index, list.nodes) & vitrailNextMask(list.nodes);
    ++length;
  }
  list.more = length > VITRAIL_SHORT_LIST;
  if (list.more) return;
  index = list.head;
  for (uint i = 0u; i < length; ++i) vitrailInsert(list.batch, vitrailLoadEntry(index, list.nodes, index));
  list.left = length;
}

// The next fragment of a list that lies sorted becomes the batch.
void vitrailStepSorted(inout VitrailList list) {
  list.batch[0] = vitrailLoadEntry(list.index, list.nodes, list.index);
  ++list.count;
  list.left = 1u;
  list.more = max(list.index, list.count) < list.nodeCount;
}
#else
// The next batch. `more` stays true where a driver ended the walk before its end.
void vitrailFillBatch(inout VitrailList list) {
  list.batch = VitrailEntry[16](VITRAIL_LAST_16);
  uint index = list.head;
  uint count = 0u; // of nodes that were walked: a corrupt list ends
  uint found = 0u;
  while (max(index, count) < list.nodeCount) {
    uint next;
    VitrailEntry entry = vitrailLoadEntry(index, list.nodes, next);
    if (next == index) break; // no node: idle lanes of CPU drivers read zeros, and would walk on for all
    index = next;
    ++count;
    if (VITRAIL_BEFORE(list.last, entry)) {
      vitrailInsert(list.batch, entry);
      ++found;
    }
  }
  bool cut = max(index, count) < list.nodeCount;
  list.left = cut ? 0u : min(found, 16u);
  list.more = cut || found > 16u;
}
#endif

// Opens the list of a pixel of the target. One outside of the frame's area has no fragments.
VitrailList vitrailOpenList(ivec2 pixel) {
  VitrailList list;
  list.nodes =
      VitrailLayout(vitrailParameters.format, vitrailParameters.samples, vitrailParameters.nearestIsOne != 0u);
  list.nodeCount = min(vitrailControl.requested, vitrailParameters.capacity);
  list.batch = VitrailEntry[16](VITRAIL_LAST_16);
  list.left = 0u;
  uvec2 local = uvec2(pixel) - uvec2(vitrailParameters.x, vitrailParameters.y);
  bool inside = local.x < vitrailParameters.width && local.y < vitrailParameters.height; // also not left or above
  list.head = VITRAIL_END;
  if (inside) list.head = vitrailHeads[local.y * vitrailParameters.width + local.x];
  list.more = list.head < list.nodeCount;
  bool reached = vitrailReachesPool();
#ifdef VITRAIL_ONLY_FORMAT
  reached = reached && vitrailParameters.format == VITRAIL_ONLY_FORMAT;
#endif
  if (!reached) list.nodeCount = 0u; // what there is remains unseen
#ifdef VITRAIL_SORTED_LISTS
  list.index = list.head;
  list.count = 0u;
  if (list.more && reached) vitrailFirstBatch(list);
#else
  list.last = VitrailEntry(uvec4(0u), 0u, 0u); // before every fragment: none has an empty key
#endif
  return list;
}

// The next fragment. False: that was the last one, or the driver ends the walk.
bool vitrailNextLayer(inout VitrailList list, out VitrailLayer layer) {
#ifdef VITRAIL_SORTED_LISTS
  if (list.left == 0u && list.more && list.nodeCount > 0u) vitrailStepSorted(list);
#else
  if (list.left == 0u && list.more && list.nodeCount > 0u) vitrailFillBatch(list);
#endif
  layer = vitrailLayerOf(list.batch[0].key, list.batch[0].word, list.nodes);
  if (list.left == 0u) return false;
#ifndef VITRAIL_SORTED_LISTS
  list.last = list.batch[0];
#endif
  vitrailShift(list.batch);
  --list.left;
  return true;
}

// Once vitrailNextLayer() has returned false, or a loop round it has ended: whether the list has more fragments,
// because the driver ended the loop, or because this shader cannot reach the pool (VITRAIL_BUFFER_REFERENCE) or is for
// another node format (VITRAIL_ONLY_FORMAT).
bool vitrailListWasCut(VitrailList list) { return list.left > 0u || list.more; }

#endif
