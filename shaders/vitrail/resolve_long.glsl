// Sorts one long fragment list where it lies and blends it front to back. No bindings: the including shader defines,
// before the include,
//
//   VitrailNode vitrailLoadNode(uint index);
//   void vitrailStoreNode(uint index, uvec2 colorAndDepth);   // the node's next stays as it is
//   void vitrailStoreNext(uint index, uint next);
//
// Blocks of 16 are sorted by insertion in registers, and merged (Knuth, The Art of Computer Programming, volume 3, 5.4: balanced
// two-way merge; its two input and two output tapes are linked lists here, so that nothing is copied). A list of n takes
// n log2(n / 16) steps, where taking the nearest fragments in repeated walks takes n^2 / 16: more than some drivers let a
// shader loop.
#ifndef VITRAIL_RESOLVE_LONG_GLSL
#define VITRAIL_RESOLVE_LONG_GLSL

#include "resolve.glsl"

// A list that is being written: its sorted runs stand one after the other.
struct VitrailOutput {
  uint head;
  uint tail; // VITRAIL_END while it is empty
  uint count;
};

const VitrailOutput VITRAIL_EMPTY = VitrailOutput(VITRAIL_END, VITRAIL_END, 0u);

void vitrailAppend(inout VitrailOutput list, uint first, uint last, uint count) {
  if (list.tail == VITRAIL_END) {
    list.head = first;
  } else {
    vitrailStoreNext(list.tail, first);
  }
  list.tail = last;
  list.count += count;
}

void vitrailSwap(inout VitrailOutput a, inout VitrailOutput b) {
  VitrailOutput held = a;
  a = b;
  b = held;
}

// Writes a key to the next of a block's nodes, if there is one.
void vitrailPut(inout uint index, inout uint last, inout uint left, uvec2 key, bool nearestIsOne) {
  if (left == 0u) return;
  uint depth = vitrailDepthKey(key.x, nearestIsOne); // its own inverse
  vitrailStoreNode(index, uvec2(key.y, depth));
  last = index;
  index = vitrailLoadNode(index).next;
  --left;
}

// Sorts the next block of the list in its own nodes and returns its last node. Here and below a turn of a loop takes
// several steps: a driver that counts turns gets fewer of them.
uint vitrailSortBlock(inout VitrailWalk walk) {
  uint index = walk.index;
  uint last = index;
  uint left = walk.count;
  uvec2 k[16] = VITRAIL_LAST_KEYS;
  while (vitrailMore(walk) && walk.count - left < VITRAIL_BLOCK) {
    uvec2 key;
    vitrailTake(walk, key);
    vitrailInsert(k, key);
    vitrailTake(walk, key);
    vitrailInsert(k, key);
  }
  left = walk.count - left;
  while (left > 0u) {
    vitrailPut(index, last, left, k[0], walk.nearestIsOne);
    vitrailPut(index, last, left, k[1], walk.nearestIsOne);
    vitrailShift(k);
    vitrailShift(k);
  }
  return last;
}

// A list that is being read, run by run.
struct VitrailTape {
  uint index; // the node under the head, and its content
  uvec2 key;
  uint next;
  uint run;  // nodes left of the current run, this one included
  uint rest; // nodes behind the current run
};

void vitrailSeek(inout VitrailTape tape, uint index, uint nodeCount, bool nearestIsOne) {
  tape.index = index;
  if (index >= nodeCount) return; // past the end of the tape
  VitrailNode node = vitrailLoadNode(index);
  tape.key = vitrailKey(node, nearestIsOne);
  tape.next = node.next;
}

VitrailTape vitrailOpen(VitrailOutput list, uint nodeCount, bool nearestIsOne) {
  VitrailTape tape = VitrailTape(VITRAIL_END, uvec2(0u), VITRAIL_END, 0u, list.count);
  vitrailSeek(tape, list.head, nodeCount, nearestIsOne);
  return tape;
}

void vitrailNextRun(inout VitrailTape tape, uint width) {
  tape.run = min(width, tape.rest);
  tape.rest -= tape.run;
}

struct VitrailMerge {
  VitrailTape a;
  VitrailTape b;
  VitrailOutput current; // where the merged run goes
  VitrailOutput other;   // where the next one goes
};

// Moves the nearer of the two nodes under the heads to the output. Runs of `width` become runs of twice that. Does nothing
// once both tapes are read.
void vitrailMergeStep(inout VitrailMerge merge, uint width, uint nodeCount, bool nearestIsOne) {
  if (merge.a.run + merge.b.run == 0u) {
    vitrailNextRun(merge.a, width);
    vitrailNextRun(merge.b, width);
    vitrailSwap(merge.current, merge.other);
    if (merge.a.run + merge.b.run == 0u) return;
  }
  bool takeA = merge.a.run > 0u && (merge.b.run == 0u || !vitrailBefore(merge.b.key, merge.a.key));
  VitrailTape tape = merge.b; // one load for both: lanes that take from different tapes stay together
  if (takeA) tape = merge.a;
  vitrailAppend(merge.current, tape.index, tape.index, 1u);
  --tape.run;
  vitrailSeek(tape, tape.next, nodeCount, nearestIsOne);
  if (takeA) {
    merge.a = tape;
  } else {
    merge.b = tape;
  }
}

// Blends the next of `sorted.nodeCount` nodes, if there is one.
void vitrailBlendNext(inout VitrailResolved result, inout VitrailWalk sorted) {
  if (sorted.count >= sorted.nodeCount) return;
  VitrailNode node = vitrailLoadNode(sorted.index);
  vitrailBlend(result, node.color);
  sorted.index = node.next;
  ++sorted.count;
}

// A list of any length. `complete` is false where the driver ended a loop before the list was done (Mesa's CPU driver
// ends a shader's loops after 65,535 turns in total).
VitrailResolved vitrailResolveLong(uint head, uint nodeCount, bool nearestIsOne) {
  VitrailWalk walk = VitrailWalk(head, 0u, nodeCount, nearestIsOne);
  VitrailMerge merge;
  merge.current = VITRAIL_EMPTY;
  merge.other = VITRAIL_EMPTY;
  while (vitrailMore(walk)) {
    uint first = walk.index;
    uint before = walk.count;
    uint last = vitrailSortBlock(walk);
    vitrailAppend(merge.current, first, last, walk.count - before);
    vitrailSwap(merge.current, merge.other);
  }
  VitrailResolved result = VitrailResolved(vec3(0.0), 1.0, walk.count, !vitrailMore(walk));

  uint width = VITRAIL_BLOCK;
  for (; width < walk.count; width *= 2u) {
    merge.a = vitrailOpen(merge.current, nodeCount, nearestIsOne);
    merge.b = vitrailOpen(merge.other, nodeCount, nearestIsOne);
    merge.current = VITRAIL_EMPTY;
    merge.other = VITRAIL_EMPTY;
    for (uint done = 0u; done < walk.count; done += 4u) {
      vitrailMergeStep(merge, width, nodeCount, nearestIsOne);
      vitrailMergeStep(merge, width, nodeCount, nearestIsOne);
      vitrailMergeStep(merge, width, nodeCount, nearestIsOne);
      vitrailMergeStep(merge, width, nodeCount, nearestIsOne);
    }
    if (merge.current.count + merge.other.count < walk.count) break;
  }
  result.complete = result.complete && width >= walk.count;

  VitrailWalk sorted = VitrailWalk(merge.current.count > 0u ? merge.current.head : merge.other.head, 0u, walk.count, false);
  while (sorted.count < walk.count && result.transmittance > 0.0) {
    vitrailBlendNext(result, sorted);
    vitrailBlendNext(result, sorted);
    vitrailBlendNext(result, sorted);
    vitrailBlendNext(result, sorted);
  }
  result.complete = result.complete && (sorted.count >= walk.count || result.transmittance == 0.0);
  return result;
}

#endif
