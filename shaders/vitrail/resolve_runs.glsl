// Resolves a list of up to 128 fragments: blocks of 16 are sorted in registers and relinked, and the up to 8 sorted
// runs are merged and blended at once, so that blending ends as soon as nothing more can be seen. No bindings: the
// including shader defines what resolve_long.glsl asks for.
#ifndef VITRAIL_RESOLVE_RUNS_GLSL
#define VITRAIL_RESOLVE_RUNS_GLSL

#include "resolve_long.glsl"

// A sorted run that is being read: the key under its head, and the node behind that.
struct VitrailRun {
  uvec4 key;
  uint next;
  uint left; // nodes, the one under the head included
};

const VitrailRun VITRAIL_NO_RUN = VitrailRun(VITRAIL_LAST.key, VITRAIL_END, 0u);
#define VITRAIL_EACH_RUN(what) what(0) what(1) what(2) what(3) what(4) what(5) what(6) what(7)
#define VITRAIL_EACH_OTHER_RUN(what) what(1) what(2) what(3) what(4) what(5) what(6) what(7)

struct VitrailRuns {
  VitrailRun runs[8];
  uint head;     // of all of them: the list stays one list
  uint count;    // fragments
  bool complete; // false: the list is longer
};

VitrailRuns vitrailSortRuns(uint head, uint nodeCount) {
  VitrailRuns sorted;
#define VITRAIL_CLEAR_RUN(r) sorted.runs[r] = VITRAIL_NO_RUN;
  VITRAIL_EACH_RUN(VITRAIL_CLEAR_RUN)
  VitrailWalk walk = VitrailWalk(head, 0u, nodeCount);
  VitrailOutput list = VITRAIL_EMPTY;
  for (uint number = 0u; number < 8u && vitrailMore(walk); ++number) {
    VitrailEntry e[16] = VitrailEntry[16](VITRAIL_LAST_16);
    uint count = vitrailTakeBlock(walk, e);
    VitrailRun run = VitrailRun(e[0].key, e[1].index, count);
#define VITRAIL_SET_RUN(r) if (number == r) sorted.runs[r] = run;
    VITRAIL_EACH_RUN(VITRAIL_SET_RUN)
    for (uint left = count; left > 0u; --left) {
      vitrailAppend(list, e[0].index, e[0].index, 1u);
      vitrailShift(e);
    }
  }
  if (list.tail != VITRAIL_END) vitrailStoreNext(list.tail, walk.index, vitrailNodes());
  sorted.head = list.head;
  sorted.count = walk.count;
  sorted.complete = !vitrailMore(walk);
  return sorted;
}

// The number of the run whose head is nearest.
uint vitrailNearestRun(VitrailRuns sorted, out VitrailRun nearest) {
  uint number = 0u;
  nearest = sorted.runs[0];
#define VITRAIL_COMPARE_RUN(r) \
  if (vitrailBefore(sorted.runs[r].key, nearest.key)) { nearest = sorted.runs[r]; number = r; }
  VITRAIL_EACH_OTHER_RUN(VITRAIL_COMPARE_RUN)
  return number;
}

// Steps a run on by one node.
VitrailRun vitrailStepRun(VitrailRun run) {
  if (run.left <= 1u) return VITRAIL_NO_RUN;
  uvec4 node = vitrailLoadNode(run.next, vitrailNodes());
  return VitrailRun(vitrailKey(node, vitrailNodes()), node.w & vitrailNextMask(vitrailNodes()), run.left - 1u);
}

VitrailResolved vitrailBlendRuns(VitrailRuns sorted) {
  VitrailResolved result = vitrailNothing();
  bool opaque = false;
  for (uint number = 0u; number < sorted.count && !opaque; ++number) {
    VitrailRun run;
    uint which = vitrailNearestRun(sorted, run);
    VitrailRun next = vitrailStepRun(run);
#define VITRAIL_REPLACE_RUN(r) if (which == r) sorted.runs[r] = next;
    VITRAIL_EACH_RUN(VITRAIL_REPLACE_RUN)
    vitrailBlendSorted(result, run.key, number);
    opaque = vitrailIsOpaque(result);
  }
  if (vitrailMaxLayers() != 0u) vitrailBlendTail(result);
  result.layers = sorted.count;
  return result;
}

// A list of any length, the shorter ones by runs.
VitrailResolved vitrailResolveRuns(uint head, uint nodeCount) {
  VitrailRuns sorted = vitrailSortRuns(head, nodeCount);
  if (!sorted.complete) return vitrailResolveLong(sorted.head, nodeCount);
  return vitrailBlendRuns(sorted);
}

#endif
