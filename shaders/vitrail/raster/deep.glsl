// Tiles whose fragments are collected, sorted and blended by passes of their own: those with more than mostWalked
// records, and those that blend.glsl leaves to them.
#ifndef VITRAIL_RASTER_DEEP_GLSL
#define VITRAIL_RASTER_DEEP_GLSL

#include "frame.glsl"

// Of each the tile, and the first of its VITRAIL_RASTER_BLOCKs and how many.
layout(VITRAIL_RASTER_BOUND(8), std430) buffer VitrailDeepBlock { uvec4 vitrailDeepTiles[]; };
// Of each of their pixels: how many fragments it has, where they begin, and how many have been collected.
layout(VITRAIL_RASTER_BOUND(11), std430) buffer VitrailDeepPixelBlock { uvec4 vitrailDeepPixels[]; };
// Deep tile, and which of its blocks.
layout(VITRAIL_RASTER_BOUND(12), std430) buffer VitrailDeepBlockBlock { uvec2 vitrailDeepBlocks[]; };
// Key and record, twice: sorted from one to the other.
layout(VITRAIL_RASTER_BOUND(13), std430) buffer VitrailDeepFragmentBlock { uvec2 vitrailDeepFragments[]; };
layout(VITRAIL_RASTER_BOUND(14), std430) buffer VitrailSortedBlock { uvec2 vitrailSortedFragments[]; };
// Pixel, and which of its chunks.
layout(VITRAIL_RASTER_BOUND(15), std430) buffer VitrailChunkBlock { uvec2 vitrailChunks[]; };

void vitrailAddDeep(uint tile, uint records_) {
  uint number;
  VITRAIL_RESERVE(vitrailRasterControl.deep, 1u, number)
  uint blocks = (records_ + VITRAIL_RASTER_BLOCK - 1u) / VITRAIL_RASTER_BLOCK;
  uint first;
  VITRAIL_RESERVE(vitrailRasterControl.blocks, blocks, first)
  if (number < vitrailRaster.deepCapacity) vitrailDeepTiles[number] = uvec4(tile, first, blocks, 0u);
  for (uint i = 0u; i < blocks && first + i < vitrailRaster.blockCapacity; ++i) {
    vitrailDeepBlocks[first + i] = uvec2(number, i);
  }
}

const uint VITRAIL_NO_PLACE = 0xffffffffu; // where fragments begin that do not fit

#endif
