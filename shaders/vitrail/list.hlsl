// Walks the fragments of one pixel in order, nearest first, in a compute or pixel shader of the host's: list.glsl for
// HLSL, shader models 5.0 to 6.x, which says when, what, and at what cost. It only reads.
//
//   #include "vitrail/list.hlsl"
//   ...
//   VitrailList list = vitrailOpenList(pixel);
//   VitrailLayer layer;
//   while (vitrailNextLayer(list, layer)) {
//     ... layer.color, layer.depth, layer.blend, layer.coverage, layer.word; or vitrailPairOf(layer) (node.hlsl):
//     color and transmittance, of what it does to the light d behind it: color + transmittance * d
//   }
//   if (vitrailListWasCut(list)) ... // there is more
//
// Standing alone it reads the target through shader resource views (VITRAIL_READ_ONLY, target.hlsl); behind
// vitrail/collect.hlsl through the unordered access views of that one. Define VITRAIL_SORTED_LISTS in shaders for
// targets with VITRAIL_RESOLVE_HOST, whose long lists the library has sorted; of other targets such a shader walks them
// in no order.
#ifndef VITRAIL_LIST_HLSL
#define VITRAIL_LIST_HLSL

#if !defined(VITRAIL_COLLECT_HLSL) && !defined(VITRAIL_READ_ONLY)
#define VITRAIL_READ_ONLY
#endif
#include "target.hlsl"
#include "sort.hlsl"

// Whether the frame has fragments that found no node: lists lack them.
bool vitrailListsLackFragments() {
  uint misfits = vitrailControl.Load(VITRAIL_CONTROL_MISFITS) | vitrailControl.Load(VITRAIL_CONTROL_MISFIT_NODES);
  return vitrailControl.Load(VITRAIL_CONTROL_REQUESTED) > vitrailParameters.capacity || misfits != 0u;
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
  uint4 node = vitrailLoadNode(index, nodes);
  uint word = 0u;
  if (vitrailParameters.userWords != 0u) word = vitrailLoadWord(index, nodes);
  next = node.w & vitrailNextMask(nodes);
  return vitrailEntry(vitrailKey(node, nodes), index, word);
}

void vitrailEmptyBatch(out VitrailEntry batch[16]) {
  [unroll] for (uint i = 0u; i < 16u; ++i) batch[i] = vitrailLast();
}

#ifdef VITRAIL_SORTED_LISTS
// Sorts a list of at most 16 fragments. A longer one lies sorted.
void vitrailFirstBatch(inout VitrailList list) {
  uint index = list.head;
  uint length = 0u;
  [loop] while (index < list.nodeCount && length <= VITRAIL_SHORT_LIST) {
    index = vitrailLoadNext(index, list.nodes) & vitrailNextMask(list.nodes);
    ++length;
  }
  list.more = length > VITRAIL_SHORT_LIST;
  if (!list.more) {
    index = list.head;
    [loop] for (uint i = 0u; i < length; ++i) {
      uint next;
      VitrailEntry entry = vitrailLoadEntry(index, list.nodes, next);
      vitrailInsert(list.batch, entry);
      index = next;
    }
    list.left = length;
  }
}

// The next fragment of a list that lies sorted becomes the batch.
void vitrailStepSorted(inout VitrailList list) {
  uint next;
  list.batch[0] = vitrailLoadEntry(list.index, list.nodes, next);
  list.index = next;
  ++list.count;
  list.left = 1u;
  list.more = max(list.index, list.count) < list.nodeCount;
}
#else
// The next batch. `more` stays true where a driver ended the walk before its end.
void vitrailFillBatch(inout VitrailList list) {
  vitrailEmptyBatch(list.batch);
  uint index = list.head;
  uint count = 0u; // of nodes that were walked: a corrupt list ends
  uint found = 0u;
  [loop] while (max(index, count) < list.nodeCount) {
    uint next;
    VitrailEntry entry = vitrailLoadEntry(index, list.nodes, next);
    if (next == index) break; // no node: idle lanes of CPU drivers read zeros, and would walk on for all
    index = next;
    ++count;
    if (vitrailBefore(list.last, entry)) {
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
VitrailList vitrailOpenList(int2 pixel) {
  VitrailList list;
  list.nodes =
      vitrailLayout(vitrailParameters.format, vitrailParameters.samples, vitrailParameters.nearestIsOne != 0u);
  list.nodeCount = min(vitrailControl.Load(VITRAIL_CONTROL_REQUESTED), vitrailParameters.capacity);
  vitrailEmptyBatch(list.batch);
  list.left = 0u;
  uint2 local = uint2(pixel) - uint2(vitrailParameters.x, vitrailParameters.y);
  bool inside = local.x < vitrailParameters.width && local.y < vitrailParameters.height; // also not left or above
  list.head = VITRAIL_END;
  if (inside) list.head = vitrailHeads.Load(4u * (local.y * vitrailParameters.width + local.x));
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
  list.last = vitrailEntry(uint4(0u, 0u, 0u, 0u), 0u, 0u); // before every fragment: none has an empty key
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
  bool found = list.left != 0u;
  if (found) {
#ifndef VITRAIL_SORTED_LISTS
    list.last = list.batch[0];
#endif
    vitrailShift(list.batch);
    --list.left;
  }
  return found;
}

// Once vitrailNextLayer() has returned false, or a loop round it has ended: whether the list has more fragments,
// because the driver ended the loop, or because this shader is for another node format (VITRAIL_ONLY_FORMAT).
bool vitrailListWasCut(VitrailList list) { return list.left > 0u || list.more; }

#endif
