// Merges sorted runs of the fragments of a pixel, two and two, from one buffer to the other. A work group makes a chunk
// of a pixel's; each thread finds out by a search where in both runs its part begins (Odeh, Green, Mwassi, Shmueli and
// Birk, "Merge path", 2012).
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/order.glsl"
#include "vitrail/raster/deep.glsl"

layout(local_size_x = VITRAIL_RASTER_GROUP) in;

layout(push_constant) uniform PassBlock { uint pass; };

const uint PART = VITRAIL_RASTER_CHUNK / VITRAIL_RASTER_GROUP;

uvec2 load(uint i) { return (pass & 1u) == 0u ? vitrailDeepFragments[i] : vitrailSortedFragments[i]; }

void store(uint i, uvec2 fragment) {
  if ((pass & 1u) == 0u) {
    vitrailSortedFragments[i] = fragment;
  } else {
    vitrailDeepFragments[i] = fragment;
  }
}

void main() {
  uint number = vitrailFlatGroup();
  if (number >= min(vitrailRasterControl.chunks.count, vitrailRaster.chunkCapacity)) return;
  uvec2 chunk = vitrailChunks[number];
  uvec4 pixel = vitrailDeepPixels[chunk.x];
  if (pixel.y == VITRAIL_NO_PLACE) return;
  uint run = VITRAIL_RASTER_CHUNK << pass;
  uint at = chunk.y * VITRAIL_RASTER_CHUNK + gl_LocalInvocationIndex * PART;
  if (at >= pixel.x) return;
  uint firstA = at / (2u * run) * (2u * run);
  uint firstB = min(firstA + run, pixel.x);
  uint end = min(firstA + 2u * run, pixel.x);
  uint before = at - firstA; // of both runs together
  uint low = before > end - firstB ? before - (end - firstB) : 0u;
  uint high = min(before, firstB - firstA);
  while (low < high) { // how many of run A come before
    uint middle = (low + high) / 2u;
    bool aIsFirst =
        !vitrailFragmentBefore(load(pixel.y + firstB + before - 1u - middle), load(pixel.y + firstA + middle));
    if (aIsFirst) {
      low = middle + 1u;
    } else {
      high = middle;
    }
  }
  uint a = firstA + low;
  uint b = firstB + before - low;
  for (uint i = at; i < min(at + PART, end); ++i) {
    bool fromA = a < firstB && (b >= end || !vitrailFragmentBefore(load(pixel.y + b), load(pixel.y + a)));
    store(pixel.y + i, load(pixel.y + (fromA ? a : b)));
    if (fromA) {
      ++a;
    } else {
      ++b;
    }
  }
}
