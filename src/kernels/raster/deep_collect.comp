// Counts the fragments of deep tiles; with VITRAIL_RASTER_FILL stores them. A work group takes a block of a tile's
// records, a thread a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/batch.glsl"
#include "vitrail/raster/opaque.glsl"
#include "vitrail/raster/deep.glsl"
#include "vitrail/raster/pages.glsl"

layout(local_size_x = VITRAIL_RASTER_PIXELS) in;

void main() {
  vitrailThread = gl_LocalInvocationIndex;
  uint block = vitrailFlatGroup();
  if (block >= min(vitrailRasterControl.blocks.count, vitrailRaster.blockCapacity)) return;
  uint deep = vitrailDeepBlocks[block].x;
  if (deep >= vitrailRaster.deepCapacity) return;
  uint tile = vitrailDeepTiles[deep].x;
  uint end = vitrailCountIn(tile);
  uint first = vitrailDeepBlocks[block].y * VITRAIL_RASTER_BLOCK;
  end = min(end, first + VITRAIL_RASTER_BLOCK);
  uint pixelNumber = deep * VITRAIL_RASTER_PIXELS + vitrailThread;
  ivec2 inTile = ivec2(vitrailThread & 7u, vitrailThread >> 3);
  ivec2 pixel = vitrailFirstPixel(tile) + inTile;
  bool inside = vitrailIsInside(pixel);
#ifdef VITRAIL_RASTER_FILL
  float farthest = inside ? vitrailFarthestDepth(pixel) : 2.0;
  uint place = vitrailDeepPixels[pixelNumber].y;
#else
  uint count = 0u;
#endif
  for (uint i = first; i < end; i += VITRAIL_RASTER_PIXELS) {
    bool any_ = i + vitrailThread < end;
    barrier(); // all have left the last batch
    uint record = any_ ? vitrailRecordOf(tile, i + vitrailThread) : 0u;
    vitrailLoadBatch(vitrailThread, any_, record, vitrailFirstPixel(tile));
    barrier();
    uvec2 bits = vitrailCovering(0u, end - i);
    if (!inside) bits = uvec2(0u);
#ifndef VITRAIL_RASTER_FILL
    count += uint(bitCount(bits.x) + bitCount(bits.y));
#else
    uint more = uint(bitCount(bits.x) + bitCount(bits.y));
    if (more == 0u || place == VITRAIL_NO_PLACE) continue;
    uint at = place + atomicAdd(vitrailDeepPixels[pixelNumber].z, more);
    while ((bits.x | bits.y) != 0u) {
      uint k = vitrailTakeBit(bits);
      vec4 plane = vitrailBatchPlanes[k];
      float depth = vitrailDepthOn(plane, inTile);
      bool hidden = vitrailIsHidden(k, depth, farthest);
      uint record = vitrailRecordOf(tile, i + k);
      vitrailDeepFragments[at++] = hidden ? uvec2(VITRAIL_NO_FRAGMENT) : uvec2(vitrailDistance(depth), record);
    }
#endif
  }
#ifndef VITRAIL_RASTER_FILL
  if (count > 0u) atomicAdd(vitrailDeepPixels[pixelNumber].x, count);
#endif
}
