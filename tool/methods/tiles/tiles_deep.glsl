// Tiles whose fragments are collected, sorted and blended by passes of their own: those with more than mostWalked
// records, and those that tiles_blend.comp leaves to them.
#ifndef VITRAIL_TOOL_TILES_DEEP_GLSL
#define VITRAIL_TOOL_TILES_DEEP_GLSL

#include "tiles_frame.glsl"

// Of each the tile, and the first of its TILES_BLOCKs and how many.
layout(set = 3, binding = 8, std430) buffer DeepBlock { uvec4 deepTiles[]; };
// Of each of their pixels: how many fragments it has, where they begin, and how many have been collected.
layout(set = 3, binding = 11, std430) buffer DeepPixelBlock { uvec4 deepPixels[]; };
layout(set = 3, binding = 12, std430) buffer BlockBlock { uvec2 deepBlocks[]; }; // deep tile, and which of its blocks
// Key and record, twice: sorted from one to the other.
layout(set = 3, binding = 13, std430) buffer FragmentBlock { uvec2 fragments[]; };
layout(set = 3, binding = 14, std430) buffer SortedBlock { uvec2 sortedFragments[]; };
layout(set = 3, binding = 15, std430) buffer ChunkBlock { uvec2 chunks[]; }; // pixel, and which of its chunks

void addDeep(uint tile, uint records_) {
  uint number;
  RESERVE(control.deep, 1u, number)
  uint blocks = (records_ + TILES_BLOCK - 1u) / TILES_BLOCK;
  uint first;
  RESERVE(control.blocks, blocks, first)
  if (number < tiles.deepCapacity) deepTiles[number] = uvec4(tile, first, blocks, 0u);
  for (uint i = 0u; i < blocks && first + i < tiles.blockCapacity; ++i) deepBlocks[first + i] = uvec2(number, i);
}

const uint NO_PLACE = 0xffffffffu; // where fragments begin that do not fit

#endif
