// Lists of any length: one invocation sorts one by relinking its nodes, which are in the pool, and hands it over.
// Between the pool (list/walk.glsl) and a sink (sink/blend.glsl), which the shader includes before. Blocks of 16 are
// sorted in registers and relinked, and merged (Knuth, The Art of Computer Programming, volume 3, 5.4: balanced two-way
// merge; its two input and two output tapes are linked lists here, so that nothing is copied). A list of n takes n
// log2(n / 16) steps, where taking the nearest fragments in repeated walks takes n^2 / 16: more than some drivers let a
// shader loop.
#ifndef VITRAIL_LONG_GLSL
#define VITRAIL_LONG_GLSL

#include "list/short.glsl"

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
    vitrailStoreNext(list.tail, first, vitrailNodes());
  }
  list.tail = last;
  list.count += count;
}

void vitrailSwap(inout VitrailOutput a, inout VitrailOutput b) {
  VitrailOutput held = a;
  a = b;
  b = held;
}

// Sorts the next block of the list, 16 nodes or what is left of it, and steps over it.
uint vitrailTakeBlock(inout VitrailWalk walk, inout VitrailEntry e[16]) {
  VitrailWalk block = VitrailWalk(walk.index, 0u, walk.nodeCount);
  vitrailSortFirst(block, e);
  walk.index = block.index;
  walk.count += block.count;
  return block.count;
}

// Sorts the next block of the list and appends it.
void vitrailSortBlock(inout VitrailWalk walk, inout VitrailOutput list) {
  VitrailEntry e[16] = VitrailEntry[16](VITRAIL_LAST_16);
  uint count = vitrailTakeBlock(walk, e);
  // Here and below a turn of a loop takes several steps: a driver that counts turns gets fewer of them.
  for (uint left = count; left > 0u; left -= min(left, 2u)) {
    vitrailAppend(list, e[0].index, e[0].index, 1u);
    if (left > 1u) vitrailAppend(list, e[1].index, e[1].index, 1u);
    vitrailShift(e);
    vitrailShift(e);
  }
}

// A list that is being read, run by run.
struct VitrailTape {
  VitrailEntry entry; // of the node under the head
  uint next;
  uint run;  // nodes left of the current run, this one included
  uint rest; // nodes behind the current run
};

void vitrailSeek(inout VitrailTape tape, uint index, uint nodeCount) {
  tape.entry.index = index;
  if (index >= nodeCount) return; // past the end of the tape
  uvec4 node = vitrailLoadNode(index, vitrailNodes());
  tape.entry.key = vitrailKey(node, vitrailNodes());
#ifdef VITRAIL_SORT_WORDS
  tape.entry.word = vitrailWordOf(index);
#endif
  tape.next = node.w & vitrailNextMask(vitrailNodes());
}

VitrailTape vitrailOpen(VitrailOutput list, uint nodeCount) {
  VitrailTape tape = VitrailTape(VITRAIL_LAST, VITRAIL_END, 0u, list.count);
  vitrailSeek(tape, list.head, nodeCount);
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

// Moves the nearer of the two nodes under the heads to the output. Runs of `width` become runs of twice that. Does
// nothing once both tapes are read.
void vitrailMergeStep(inout VitrailMerge merge, uint width, uint nodeCount) {
  if (merge.a.run + merge.b.run == 0u) {
    vitrailNextRun(merge.a, width);
    vitrailNextRun(merge.b, width);
    vitrailSwap(merge.current, merge.other);
    if (merge.a.run + merge.b.run == 0u) return;
  }
  bool takeA = merge.a.run > 0u && (merge.b.run == 0u || !VITRAIL_BEFORE(merge.b.entry, merge.a.entry));
  VitrailTape tape = merge.b; // one load for both: lanes that take from different tapes stay together
  if (takeA) tape = merge.a;
  vitrailAppend(merge.current, tape.entry.index, tape.entry.index, 1u);
  --tape.run;
  vitrailSeek(tape, tape.next, nodeCount);
  if (takeA) {
    merge.a = tape;
  } else {
    merge.b = tape;
  }
}

// A list of any length, sorted: follow it for `count` nodes. `complete` is false where the driver ended a loop before
// the list was done (Mesa's CPU driver ends a shader's loops after 65,535 turns in total).
struct VitrailSorted {
  uint head;
  uint count;
  bool complete;
};

VitrailSorted vitrailSortLong(uint head, uint nodeCount) {
  VitrailWalk walk = VitrailWalk(head, 0u, nodeCount);
  VitrailMerge merge;
  merge.current = VITRAIL_EMPTY;
  merge.other = VITRAIL_EMPTY;
  while (vitrailMore(walk)) {
    vitrailSortBlock(walk, merge.current);
    vitrailSwap(merge.current, merge.other);
  }
  VitrailSorted sorted = VitrailSorted(VITRAIL_END, walk.count, !vitrailMore(walk));

  uint width = VITRAIL_SHORT_LIST;
  for (; width < walk.count; width *= 2u) {
    merge.a = vitrailOpen(merge.current, nodeCount);
    merge.b = vitrailOpen(merge.other, nodeCount);
    merge.current = VITRAIL_EMPTY;
    merge.other = VITRAIL_EMPTY;
    for (uint done = 0u; done < walk.count; done += 4u) {
      vitrailMergeStep(merge, width, nodeCount);
      vitrailMergeStep(merge, width, nodeCount);
      vitrailMergeStep(merge, width, nodeCount);
      vitrailMergeStep(merge, width, nodeCount);
    }
    if (merge.current.count + merge.other.count < walk.count) break;
  }
  sorted.complete = sorted.complete && width >= walk.count;
  if (merge.current.count == 0u) merge.current = merge.other;
  if (merge.current.tail != VITRAIL_END) vitrailStoreNext(merge.current.tail, VITRAIL_END, vitrailNodes());
  sorted.head = merge.current.head;
  return sorted;
}

// Hands over the next node of a sorted list, if there is one.
void vitrailPutNext(inout VitrailSink sink, inout VitrailWalk sorted) {
  uint number = sorted.count;
  if (!vitrailMore(sorted)) return;
  VitrailEntry entry = vitrailTake(sorted);
  vitrailPut(sink, entry, number);
}

// A list that lies sorted, from its head.
VitrailSink vitrailSortedList(uint head, uint nodeCount) {
  VitrailSink sink = vitrailBegin();
  VitrailWalk walk = VitrailWalk(head, 0u, nodeCount);
  bool enough = false;
  while (vitrailMore(walk) && !enough) {
    vitrailPutNext(sink, walk);
    vitrailPutNext(sink, walk);
    vitrailPutNext(sink, walk);
    vitrailPutNext(sink, walk);
    enough = vitrailHasEnough(sink);
  }
  vitrailEnd(sink);
  sink.layers = walk.count;
  sink.complete = enough || !vitrailMore(walk);
  return sink;
}

// A list of any length, from its head, which another node is afterwards.
VitrailSink vitrailLong(inout uint head, uint nodeCount) {
  VitrailSorted sorted = vitrailSortLong(head, nodeCount);
  head = sorted.head;
  VitrailSink sink = vitrailSortedList(sorted.head, nodeCount);
  sink.layers = sorted.count;
  sink.complete = sink.complete && sorted.complete;
  return sink;
}

#endif
