// Merges sorted runs of the fragments of a pixel, two and two, from one buffer to the other. A work group makes a chunk
// of a pixel's; each thread finds out by a search where in both runs its part begins (Odeh, Green, Mwassi, Shmueli and
// Birk, "Merge path", 2012).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "source_order.glsl"
#include "tiles_deep.glsl"

layout(local_size_x = TILES_GROUP) in;

layout(push_constant) uniform PassBlock { uint pass; };

const uint PART = TILES_CHUNK / TILES_GROUP;

uvec2 load(uint i) { return (pass & 1u) == 0u ? fragments[i] : sortedFragments[i]; }

void store(uint i, uvec2 fragment) {
  if ((pass & 1u) == 0u) {
    sortedFragments[i] = fragment;
  } else {
    fragments[i] = fragment;
  }
}

void main() {
  uint number = flatGroup();
  if (number >= min(control.chunks.count, tiles.chunkCapacity)) return;
  uvec2 chunk = chunks[number];
  uvec4 pixel = deepPixels[chunk.x];
  if (pixel.y == NO_PLACE) return;
  uint run = TILES_CHUNK << pass;
  uint at = chunk.y * TILES_CHUNK + gl_LocalInvocationIndex * PART;
  if (at >= pixel.x) return;
  uint firstA = at / (2u * run) * (2u * run);
  uint firstB = min(firstA + run, pixel.x);
  uint end = min(firstA + 2u * run, pixel.x);
  uint before = at - firstA; // of both runs together
  uint low = before > end - firstB ? before - (end - firstB) : 0u;
  uint high = min(before, firstB - firstA);
  while (low < high) { // how many of run A come before
    uint middle = (low + high) / 2u;
    bool aIsFirst = !fragmentBefore(load(pixel.y + firstB + before - 1u - middle), load(pixel.y + firstA + middle));
    if (aIsFirst) {
      low = middle + 1u;
    } else {
      high = middle;
    }
  }
  uint a = firstA + low;
  uint b = firstB + before - low;
  for (uint i = at; i < min(at + PART, end); ++i) {
    bool fromA = a < firstB && (b >= end || !fragmentBefore(load(pixel.y + b), load(pixel.y + a)));
    store(pixel.y + i, load(pixel.y + (fromA ? a : b)));
    if (fromA) {
      ++a;
    } else {
      ++b;
    }
  }
}
