// Lists of at most 16 fragments, which one invocation sorts in registers: by networks with VITRAIL_NETWORKS, else by
// insertion. Longer ones are left to another kernel: one for every length would make the many short lists pay, in
// registers and in code, for the few long ones. Between a producer (list/walk.glsl) and a sink (sink/blend.glsl), which
// the shader includes before.
#ifndef VITRAIL_SHORT_GLSL
#define VITRAIL_SHORT_GLSL

#if VITRAIL_NETWORKS
#include "list/networks.glsl"
#endif

#define VITRAIL_TAKE(i) e[i] = vitrailTake(walk);
#define VITRAIL_PUT(i) if (walk.count > i) vitrailPut(sink, e[i], i);

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
VitrailSink vitrailShort(inout VitrailWalk walk) {
  VitrailEntry e[16] = VitrailEntry[16](VITRAIL_LAST_16);
  vitrailSortFirst(walk, e);
  VitrailSink sink = vitrailBegin();
  sink.layers = walk.count;
  sink.complete = !vitrailMore(walk);
  if (!sink.complete) return sink;
#if VITRAIL_NETWORKS
  VITRAIL_PUT(0) VITRAIL_PUT(1) VITRAIL_PUT(2) VITRAIL_PUT(3)
  if (walk.count > 4u) {
    VITRAIL_PUT(4) VITRAIL_PUT(5) VITRAIL_PUT(6) VITRAIL_PUT(7)
  }
  if (walk.count > 8u) {
    VITRAIL_PUT(8) VITRAIL_PUT(9) VITRAIL_PUT(10) VITRAIL_PUT(11)
    VITRAIL_PUT(12) VITRAIL_PUT(13) VITRAIL_PUT(14) VITRAIL_PUT(15)
  }
#else
  for (uint number = 0u; number < walk.count; ++number) {
    vitrailPut(sink, e[0], number);
    vitrailShift(e);
  }
#endif
  return sink;
}

#endif
