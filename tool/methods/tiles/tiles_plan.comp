// Gives each tile room for its pairs, and puts it on the list of its class.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tiles_deep.glsl"

layout(local_size_x = 256) in;

layout(set = 3, binding = 17, std430) buffer ClassBlock { TilesClasses classes; };

shared uint groupPairs;
shared uint groupFirst;
shared uint groupCount[TILES_CLASSES];
shared uint groupList[TILES_CLASSES];

void main() {
  uint thread = gl_LocalInvocationIndex;
  if (thread < TILES_CLASSES) groupCount[thread] = 0u;
  if (thread == TILES_CLASSES) groupPairs = 0u;
  barrier();
  uint tile = flatGroup() * 256u + thread;
  bool isRead = tile < tiles.tilesX * tiles.tilesY && hasRecords();
  uint count = isRead ? tileRecords[tile].x : 0u;
  uint place = 0u;
  uint number = 0u;
  uint kind = count <= TILES_FEW ? 0u : count <= TILES_PIXELS ? 1u : count <= TILES_SHALLOW ? 2u : 3u;
  if (count > 0u) {
    place = atomicAdd(groupPairs, count);
    if (count <= tiles.mostWalked) number = atomicAdd(groupCount[kind], 1u);
  }
  barrier();
  if (thread == 0u && groupPairs > 0u) groupFirst = atomicAdd(control.pairs, groupPairs);
  if (thread < TILES_CLASSES && groupCount[thread] > 0u) {
    RESERVE(classes.of[thread], groupCount[thread], groupList[thread])
  }
  barrier();
  if (count == 0u) return;
  tileRecords[tile].y = groupFirst + place;
  if (count > tiles.mostWalked) {
    addDeep(tile, count);
  } else {
    tileList[kind * tiles.tilesX * tiles.tilesY + groupList[kind] + number] = tile;
  }
}
