// Sorts chunks of the fragments of a pixel, a work group each (Batcher, "Sorting networks and their applications",
// 1968).
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/order.glsl"
#include "vitrail/raster/deep.glsl"

layout(local_size_x = VITRAIL_RASTER_GROUP) in;

shared uvec2 sorted[VITRAIL_RASTER_CHUNK];

void main() {
  uint number = vitrailFlatGroup();
  if (number >= min(vitrailRasterControl.chunks.count, vitrailRaster.chunkCapacity)) return;
  uvec2 chunk = vitrailChunks[number];
  uvec4 pixel = vitrailDeepPixels[chunk.x];
  if (pixel.y == VITRAIL_NO_PLACE) return;
  uint first = chunk.y * VITRAIL_RASTER_CHUNK;
  uint count = min(pixel.x - first, VITRAIL_RASTER_CHUNK);
  first += pixel.y;
  uint size = 2u;
  while (size < count) size *= 2u;
  for (uint i = gl_LocalInvocationIndex; i < size; i += VITRAIL_RASTER_GROUP) {
    sorted[i] = i < count ? vitrailDeepFragments[first + i] : uvec2(VITRAIL_NO_FRAGMENT);
  }
  barrier();
  for (uint run = 2u; run <= size; run *= 2u) {
    for (uint step = run / 2u; step > 0u; step /= 2u) {
      for (uint i = gl_LocalInvocationIndex; i < size / 2u; i += VITRAIL_RASTER_GROUP) {
        uint low = 2u * i - (i & (step - 1u));
        uvec2 a = sorted[low];
        uvec2 b = sorted[low + step];
        bool rising = (low & run) == 0u;
        if (rising ? vitrailFragmentBefore(b, a) : vitrailFragmentBefore(a, b)) {
          sorted[low] = b;
          sorted[low + step] = a;
        }
      }
      barrier();
    }
  }
  for (uint i = gl_LocalInvocationIndex; i < count; i += VITRAIL_RASTER_GROUP) {
    vitrailDeepFragments[first + i] = sorted[i];
  }
}
