// Records of a tile, TILES_PIXELS at a time, by a work group with a thread for each pixel: a thread finds out which of
// them cover its pixel.
#ifndef VITRAIL_TOOL_TILES_BATCH_GLSL
#define VITRAIL_TOOL_TILES_BATCH_GLSL

#include "tiles_frame.glsl"

shared uint sharedMasks[2][TILES_PIXELS]; // the pixels that each covers
shared vec4 sharedPlanes[TILES_PIXELS];

uint thread; // set by main()

ivec2 firstPixel(uint tile) {
  return ivec2(tile % tiles.tilesX, tile / tiles.tilesX) * 8 + ivec2(0, tiles.top);
}
bool isInside(ivec2 pixel) { return pixel.x < int(tiles.width) && pixel.y < int(tiles.bottom); }

// Each thread loads one, or none. A barrier has to come before and after.
void loadBatch(bool any_, uint record) {
  uvec2 mask = any_ ? records[2u * record].xy : uvec2(0u);
  if (any_) sharedPlanes[thread] = uintBitsToFloat(records[2u * record + 1u]);
  sharedMasks[0][thread] = mask.x;
  sharedMasks[1][thread] = mask.y;
}

// Those that cover the thread's pixel, a bit each.
uvec2 covering() {
  uint half_ = thread >> 5;
  uint bit = thread & 31u;
  uvec2 bits = uvec2(0u);
  for (uint i = 0u; i < 32u; ++i) {
    bits.x |= (sharedMasks[half_][i] >> bit & 1u) << i;
    bits.y |= (sharedMasks[half_][32u + i] >> bit & 1u) << i;
  }
  return bits;
}

uint firstBit(uvec2 bits) { return bits.x != 0u ? uint(findLSB(bits.x)) : 32u + uint(findLSB(bits.y)); }

uint takeBit(inout uvec2 bits) {
  uint first = firstBit(bits);
  if (bits.x != 0u) {
    bits.x &= bits.x - 1u;
  } else {
    bits.y &= bits.y - 1u;
  }
  return first;
}

#endif
