// Brings the records of each tile together.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tiles_frame.glsl"

layout(local_size_x = 256) in;

void main() {
  uint count = hasRecords() ? min(control.records, tiles.recordCapacity) : 0u;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += TILES_SCATTER * 256u) {
    uint tile = places[3u * i];
    if (tile == NO_TILE) continue;
    pairs[tileRecords[tile].y + places[3u * i + 1u]] = uvec2(places[3u * i + 2u], i);
  }
}
