// Gives the pixels of deep tiles room for their fragments, and lists the chunks in which these are sorted. A work group
// a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tiles_deep.glsl"

layout(local_size_x = TILES_PIXELS) in;

shared uint groupFragments;
shared uint groupChunks;
shared uint groupMost;
shared uint groupFirst;
shared uint groupFirstChunk;

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint deep = flatGroup();
  if (deep >= min(control.deep.count, tiles.deepCapacity)) return;
  if (thread == 0u) groupFragments = groupChunks = groupMost = 0u;
  barrier();
  uint pixel = deep * TILES_PIXELS + thread;
  uint count = deepPixels[pixel].x;
  uint chunkCount = (count + TILES_CHUNK - 1u) / TILES_CHUNK;
  if (count > 0xffffffffu / TILES_PIXELS) atomicAdd(control.fragmentsHigh, 1u); // the sum of a tile may come round
  uint place = atomicAdd(groupFragments, count);
  uint chunk = atomicAdd(groupChunks, chunkCount);
  atomicMax(groupMost, count);
  barrier();
  if (thread == 0u) {
    TAKE_PLACES(control.fragments, control.fragmentsHigh, groupFragments, groupFirst)
    uint first;
    RESERVE(control.chunks, groupChunks, first)
    groupFirstChunk = first;
    atomicMax(control.mostFragments, groupMost);
  }
  barrier();
  place += groupFirst;
  bool fits = place <= tiles.fragmentCapacity && count <= tiles.fragmentCapacity - place;
  deepPixels[pixel].y = fits ? place : NO_PLACE;
  chunk += groupFirstChunk;
  for (uint i = 0u; i < chunkCount && chunk + i < tiles.chunkCapacity; ++i) chunks[chunk + i] = uvec2(pixel, i);
}
