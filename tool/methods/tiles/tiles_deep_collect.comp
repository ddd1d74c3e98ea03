// Counts the fragments of deep tiles; with TILES_FILL stores them. A work group takes a block of a tile's records, a
// thread a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "batch.glsl"
#include "opaque_depth.glsl"
#include "tiles_deep.glsl"

layout(local_size_x = TILES_PIXELS) in;

void main() {
  thread = gl_LocalInvocationIndex;
  uint block = flatGroup();
  if (block >= min(control.blocks.count, tiles.blockCapacity)) return;
  uint deep = deepBlocks[block].x;
  if (deep >= tiles.deepCapacity) return;
  uint tile = deepTiles[deep].x;
  uint end = tileRecords[tile].x;
  uint first = deepBlocks[block].y * TILES_BLOCK;
  end = min(end, first + TILES_BLOCK);
  uint pairsFirst = tileRecords[tile].y;
  uint pixelNumber = deep * TILES_PIXELS + thread;
  ivec2 inTile = ivec2(thread & 7u, thread >> 3);
  ivec2 pixel = firstPixel(tile) + inTile;
  bool inside = isInside(pixel);
#ifdef TILES_FILL
  float farthest = inside ? farthestDepth(pixel) : 2.0;
  uint place = deepPixels[pixelNumber].y;
#else
  uint count = 0u;
#endif
  for (uint i = first; i < end; i += TILES_PIXELS) {
    bool any_ = i + thread < end;
    barrier(); // all have left the last batch
    loadBatch(any_, any_ ? pairs[pairsFirst + i + thread].y : 0u, firstPixel(tile));
    barrier();
    uvec2 bits = covering();
    if (!inside) bits = uvec2(0u);
#ifndef TILES_FILL
    count += uint(bitCount(bits.x) + bitCount(bits.y));
#else
    uint more = uint(bitCount(bits.x) + bitCount(bits.y));
    if (more == 0u || place == NO_PLACE) continue;
    uint at = place + atomicAdd(deepPixels[pixelNumber].z, more);
    while ((bits.x | bits.y) != 0u) {
      uint k = takeBit(bits);
      vec4 plane = sharedPlanes[k];
      float depth = depthOn(plane, inTile);
      bool hidden = isHidden(k, depth, farthest);
      fragments[at++] = hidden ? uvec2(NO_FRAGMENT) : uvec2(keyOf(depth), pairs[pairsFirst + i + k].y);
    }
#endif
  }
#ifndef TILES_FILL
  if (count > 0u) atomicAdd(deepPixels[pixelNumber].x, count);
#endif
}
