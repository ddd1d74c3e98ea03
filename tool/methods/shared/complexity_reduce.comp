// One step of a reduction over an image: a work group takes two items a thread to one, halving them each time.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "complexity_shared.h"

layout(local_size_x = COMPLEXITY_GROUP) in;

#ifndef VITRAIL_OPENGL // which counts in the image alone
layout(set = 0, binding = 0) uniform utexture2D stencil;
#endif
layout(BOUND(0, 1, 0), r32ui) uniform readonly uimage2D counts;
layout(BOUND(0, 2, 5), std430) buffer PartsBlock { Complexity parts[]; };

PUSHED ReductionBlock { ComplexityReduction reduction; };

shared Complexity items[COMPLEXITY_GROUP];

Complexity ofPixel(uint layers) {
  uint kept = min(layers, reduction.nearest);
  return Complexity(layers, min(layers, 1u), uint(layers > kept), layers, 0u, kept, 0u, 0u);
}

Complexity load(uint i) {
  if (i >= reduction.count) return ofPixel(0u);
  if (reduction.source == COMPLEXITY_PARTS) return parts[reduction.from + i];
  ivec2 pixel = ivec2(i % reduction.width, i / reduction.width);
#ifndef VITRAIL_OPENGL
  if (reduction.source == COMPLEXITY_STENCIL) return ofPixel(texelFetch(stencil, pixel, 0).r);
#endif
  return ofPixel(imageLoad(counts, pixel).r);
}

Complexity both(Complexity a, Complexity b) {
  uint carry;
  a.deepest = max(a.deepest, b.deepest);
  a.coveredPixels += b.coveredPixels;
  a.deeperPixels += b.deeperPixels;
  a.surfacesLow = uaddCarry(a.surfacesLow, b.surfacesLow, carry);
  a.surfacesHigh += b.surfacesHigh + carry;
  a.keptLow = uaddCarry(a.keptLow, b.keptLow, carry);
  a.keptHigh += b.keptHigh + carry;
  return a;
}

void main() {
  uint group = gl_WorkGroupID.y * COMPLEXITY_ROW + gl_WorkGroupID.x;
  uint thread = gl_LocalInvocationIndex;
  uint first = group * 2u * COMPLEXITY_GROUP + thread;
  items[thread] = both(load(first), load(first + COMPLEXITY_GROUP));
  for (uint rest = COMPLEXITY_GROUP / 2u; rest > 0u; rest /= 2u) {
    barrier();
    if (thread < rest) items[thread] = both(items[thread], items[thread + rest]);
  }
  if (thread == 0u && group * 2u * COMPLEXITY_GROUP < reduction.count) parts[reduction.to + group] = items[0];
}
