// The blending sink of a group of invocations (list/group.glsl), of which each has blended its part of a list.
#ifndef VITRAIL_BLEND_GROUP_GLSL
#define VITRAIL_BLEND_GROUP_GLSL

#extension GL_KHR_shader_subgroup_shuffle : require

#include "sink/blend.glsl"

VitrailPair vitrailPairOfLane(VitrailPair pair, uint mask) {
  return VitrailPair(subgroupShuffleXor(pair.color, mask), subgroupShuffleXor(pair.transmittance, mask));
}

VitrailSums vitrailSumsOfLane(VitrailSums sums, uint mask) {
  return VitrailSums(subgroupShuffleXor(sums.color, mask), subgroupShuffleXor(sums.opacity, mask),
                     subgroupShuffleXor(sums.density, mask), subgroupShuffleXor(sums.filters, mask));
}

// Puts together what invocations have blended: the first half is in front of the second.
void vitrailJoinLanes(inout VitrailSink sink, uint lane, uint mask) {
  bool behind = (lane & mask) != 0u;
  VitrailPair other;
  VitrailPair front;
#define VITRAIL_JOIN_LANES(s) \
  other = vitrailPairOfLane(sink.pairs[s], mask); \
  front = sink.pairs[s]; \
  if (behind) { front = other; other = sink.pairs[s]; } \
  vitrailCompose(front, other); \
  sink.pairs[s] = front; \
  if (vitrailMaxLayers() != 0u) vitrailAddSums(sink.tails[s], vitrailSumsOfLane(sink.tails[s], mask));
  VITRAIL_EACH_SAMPLE(VITRAIL_JOIN_LANES)
  sink.layers += subgroupShuffleXor(sink.layers, mask);
  uint otherComplete = subgroupShuffleXor(uint(sink.complete), mask); // by all of them: && would be a branch
  sink.complete = sink.complete && otherComplete != 0u;
}

#endif
