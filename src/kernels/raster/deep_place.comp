// Gives the pixels of deep tiles room for their fragments, and lists the chunks in which these are sorted. A work group
// a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/deep.glsl"

layout(local_size_x = VITRAIL_RASTER_PIXELS) in;

shared uint groupFragments;
shared uint groupChunks;
shared uint groupMost;
shared uint groupFirst;
shared uint groupFirstChunk;

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint deep = vitrailFlatGroup();
  if (deep >= min(vitrailRasterControl.deep.count, vitrailRaster.deepCapacity)) return;
  if (thread == 0u) groupFragments = groupChunks = groupMost = 0u;
  barrier();
  uint pixel = deep * VITRAIL_RASTER_PIXELS + thread;
  uint count = vitrailDeepPixels[pixel].x;
  uint chunkCount = (count + VITRAIL_RASTER_CHUNK - 1u) / VITRAIL_RASTER_CHUNK;
  uint place;
  // The sum of a tile may come round, too.
  VITRAIL_TAKE_PLACES(groupFragments, vitrailRasterControl.fragmentsHigh, count, place)
  uint chunk = atomicAdd(groupChunks, chunkCount);
  atomicMax(groupMost, count);
  barrier();
  if (thread == 0u) {
    VITRAIL_TAKE_PLACES(vitrailRasterControl.fragments, vitrailRasterControl.fragmentsHigh, groupFragments, groupFirst)
    uint first;
    VITRAIL_RESERVE(vitrailRasterControl.chunks, groupChunks, first)
    groupFirstChunk = first;
    atomicMax(vitrailRasterControl.mostFragments, groupMost);
  }
  barrier();
  place += groupFirst;
  bool fits = place <= vitrailRaster.fragmentCapacity && count <= vitrailRaster.fragmentCapacity - place;
  vitrailDeepPixels[pixel].y = fits ? place : VITRAIL_NO_PLACE;
  chunk += groupFirstChunk;
  for (uint i = 0u; i < chunkCount && chunk + i < vitrailRaster.chunkCapacity; ++i) {
    vitrailChunks[chunk + i] = uvec2(pixel, i);
  }
}
