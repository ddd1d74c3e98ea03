// Sorts chunks of the fragments of a pixel, a work group each (Batcher, "Sorting networks and their applications",
// 1968).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "source_order.glsl"
#include "tiles_deep.glsl"

layout(local_size_x = TILES_GROUP) in;

shared uvec2 sorted[TILES_CHUNK];

void main() {
  uint number = flatGroup();
  if (number >= min(control.chunks.count, tiles.chunkCapacity)) return;
  uvec2 chunk = chunks[number];
  uvec4 pixel = deepPixels[chunk.x];
  if (pixel.y == NO_PLACE) return;
  uint first = chunk.y * TILES_CHUNK;
  uint count = min(pixel.x - first, TILES_CHUNK);
  first += pixel.y;
  uint size = 2u;
  while (size < count) size *= 2u;
  for (uint i = gl_LocalInvocationIndex; i < size; i += TILES_GROUP) {
    sorted[i] = i < count ? fragments[first + i] : uvec2(NO_FRAGMENT);
  }
  barrier();
  for (uint run = 2u; run <= size; run *= 2u) {
    for (uint step = run / 2u; step > 0u; step /= 2u) {
      for (uint i = gl_LocalInvocationIndex; i < size / 2u; i += TILES_GROUP) {
        uint low = 2u * i - (i & (step - 1u));
        uvec2 a = sorted[low];
        uvec2 b = sorted[low + step];
        bool rising = (low & run) == 0u;
        if (rising ? fragmentBefore(b, a) : fragmentBefore(a, b)) {
          sorted[low] = b;
          sorted[low + step] = a;
        }
      }
      barrier();
    }
  }
  for (uint i = gl_LocalInvocationIndex; i < count; i += TILES_GROUP) fragments[first + i] = sorted[i];
}
