// A sink: what becomes of the fragments of a list, which a class of lists (list/short.glsl and so on) sorts and hands
// over. Any sink has
//
//   VitrailSink                                     what is there so far, with
//     uint layers                                     fragments of the list, as far as the class has seen
//     bool complete                                   false: there is more in the list than was handed over
//   VitrailSink vitrailBegin()
//   void vitrailPut(inout VitrailSink, VitrailEntry, uint number)    the next fragment in order, the number-th from 0
//   bool vitrailHasEnough(VitrailSink)              whether nothing farther away can change it
//   void vitrailPutRest(inout VitrailSink, VitrailEntry)             one behind the nearest maxLayers, in any order
//   void vitrailEnd(inout VitrailSink)              after the last fragment of a list with more than 16; shorter ones
//                                                   have no rest
//
// and this one blends them front to back. sink/copy.glsl writes them out. Before the include, a shader defines
//
//   VITRAIL_ACCUMULATORS              1, or 8 where one invocation blends all samples of a pixel
//   uint vitrailVisible(uvec4 key)    the samples that a fragment adds to, one bit each; bit 0 with one accumulator
//   VitrailLayout vitrailNodes()      how the nodes are stored
//   uint vitrailMaxLayers()           VitrailVkTargetDesc::maxLayers
#ifndef VITRAIL_BLEND_GLSL
#define VITRAIL_BLEND_GLSL

#include "vitrail/sort.glsl"
#include "vitrail/sums.glsl"

struct VitrailSink {
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

VitrailSink vitrailBegin() {
  VitrailSink sink;
#define VITRAIL_CLEAR(s) \
  sink.pairs[s] = VitrailPair(vec3(0.0), vec4(1.0)); \
  sink.tails[s] = VITRAIL_NO_SUMS;
  VITRAIL_EACH_SAMPLE(VITRAIL_CLEAR)
  sink.layers = 0u;
  sink.complete = true;
  return sink;
}

void vitrailCompose(inout VitrailPair front, VitrailPair behind) {
  front.color += front.transmittance.rgb * behind.color;
  // Colours above 1 may multiply light beyond what a float holds, and what is infinite makes a NaN of darkness.
  front.transmittance = min(front.transmittance * behind.transmittance, 1e37);
}

// Puts a fragment behind what is there.
void vitrailBlend(inout VitrailSink sink, uvec4 key) {
  VitrailPair pair = vitrailPairOf(key, vitrailNodes());
  uint visible = vitrailVisible(key);
#define VITRAIL_COMPOSE(s) if ((visible & (1u << s)) != 0u) vitrailCompose(sink.pairs[s], pair);
  VITRAIL_EACH_SAMPLE(VITRAIL_COMPOSE)
}

// Adds a fragment to the tail, whose order does not matter.
void vitrailAddTail(inout VitrailSink sink, uvec4 key) {
  VitrailSums sums = vitrailSumsOf(key, vitrailNodes(), 1.0);
  uint visible = vitrailVisible(key);
#define VITRAIL_ADD(s) if ((visible & (1u << s)) != 0u) vitrailAddSums(sink.tails[s], sums);
  VITRAIL_EACH_SAMPLE(VITRAIL_ADD)
}

// Puts the tail behind what is there. By a copy: NVIDIA's compiler of GLSL (580, for OpenGL) loses what is written
// through two references into one structure here.
void vitrailBlendTail(inout VitrailSink sink) {
#define VITRAIL_BLEND_TAIL(s) { \
  VitrailPair blended = sink.pairs[s]; \
  vitrailCompose(blended, vitrailPairOfSums(sink.tails[s])); \
  sink.pairs[s] = blended; \
}
  VITRAIL_EACH_SAMPLE(VITRAIL_BLEND_TAIL)
}

void vitrailPutRest(inout VitrailSink sink, VitrailEntry entry) { vitrailAddTail(sink, entry.key); }

void vitrailPut(inout VitrailSink sink, VitrailEntry entry, uint number) {
  if (vitrailMaxLayers() == 0u || number < vitrailMaxLayers()) {
    vitrailBlend(sink, entry.key);
  } else {
    vitrailAddTail(sink, entry.key);
  }
}

void vitrailEnd(inout VitrailSink sink) {
  if (vitrailMaxLayers() != 0u) vitrailBlendTail(sink);
}

// The whole list at once, as sums (list/sums.glsl).
void vitrailPutSums(inout VitrailSink sink, VitrailSums sums) {
  VitrailPair pair = vitrailPairOfSums(sums);
#define VITRAIL_SET_PAIR(s) sink.pairs[s] = pair;
  VITRAIL_EACH_SAMPLE(VITRAIL_SET_PAIR)
}

// Whether nothing farther away can change a bit, for colours up to the largest 16-bit float.
bool vitrailHasEnough(VitrailSink sink) {
  bool opaque = true;
#define VITRAIL_IS_OPAQUE(s) \
  opaque = opaque && sink.pairs[s].transmittance.a < 2.98e-8 && \
           fma(sink.pairs[s].transmittance.rgb, vec3(65504.0), sink.pairs[s].color) == sink.pairs[s].color;
  VITRAIL_EACH_SAMPLE(VITRAIL_IS_OPAQUE)
  return opaque;
}

#endif
