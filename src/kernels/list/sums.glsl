// Lists of a frame that overflowed: what is stored and what is missing of a pixel, without order. Between a producer
// (list/walk.glsl) and the blending sink (sink/blend.glsl), which the shader includes before.
#ifndef VITRAIL_LIST_SUMS_GLSL
#define VITRAIL_LIST_SUMS_GLSL

#include "vitrail/sums.glsl"

// All of a list by sums alone, whatever its order, `missing` included: fragments of this pixel that found no node.
VitrailSink vitrailSummed(uint head, uint nodeCount, VitrailSums missing) {
  VitrailWalk walk = VitrailWalk(head, 0u, nodeCount);
  while (vitrailMore(walk)) {
    uvec4 key = vitrailTake(walk).key;
    float weight = float(bitCount(vitrailKeyCoverage(key, vitrailNodes()))) / float(vitrailNodes().samples);
    vitrailAddSums(missing, vitrailMergeFilters(vitrailSumsOf(key, vitrailNodes(), weight)));
  }
  VitrailSink sink = vitrailBegin();
  vitrailPutSums(sink, missing);
  sink.layers = walk.count;
  return sink;
}

#endif
