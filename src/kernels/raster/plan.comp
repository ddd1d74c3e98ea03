// Gives each tile room for its pairs, and puts it on the list of its class.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/deep.glsl"

layout(local_size_x = 256) in;

layout(VITRAIL_RASTER_BOUND(17), std430) buffer VitrailTileClassBlock { VitrailRasterTileClasses vitrailTileClasses; };

shared uint groupPairs;
shared uint groupFirst;
shared uint groupCount[VITRAIL_RASTER_CLASSES];
shared uint groupList[VITRAIL_RASTER_CLASSES];

void main() {
  uint thread = gl_LocalInvocationIndex;
  if (thread < VITRAIL_RASTER_CLASSES) groupCount[thread] = 0u;
  if (thread == VITRAIL_RASTER_CLASSES) groupPairs = 0u;
  barrier();
  uint tile = vitrailFlatGroup() * 256u + thread;
  uint tiles = vitrailRaster.tilesX * vitrailRaster.tilesY;
  bool isRead = tile < tiles && vitrailHasRecords();
  uint count = isRead ? vitrailTileRecords[tile].x : 0u;
  if (!vitrailHasRecords() && tile < tiles) vitrailTileRecords[tile].x = 0u; // mean.comp
  uint place = 0u;
  uint number = 0u;
  // Of the pixels that some of the records cover: triangles.glsl.
  uint depth = isRead ? vitrailTileRecords[tile].y * VITRAIL_RASTER_SHARE / VITRAIL_RASTER_PIXELS : 0u;
  uint most = VITRAIL_RASTER_SAMPLES > 1u      ? VITRAIL_RASTER_SEVERAL_DEPTH
              : count <= VITRAIL_RASTER_PIXELS ? VITRAIL_RASTER_FLAT_DEPTH
                                               : VITRAIL_RASTER_MORE_DEPTH;
  uint kind = count <= VITRAIL_RASTER_FEW       ? 0u
              : depth > most                    ? 5u
              : count <= VITRAIL_RASTER_PIXELS  ? 1u
              : depth > VITRAIL_RASTER_DEPTH    ? 4u
              : count <= VITRAIL_RASTER_SHALLOW ? 2u
                                                : 3u;
  if (count > 0u) {
    place = atomicAdd(groupPairs, count);
    if (count <= vitrailRaster.mostWalked) number = atomicAdd(groupCount[kind], 1u);
  }
  barrier();
  if (thread == 0u && groupPairs > 0u) groupFirst = atomicAdd(vitrailRasterControl.pairs, groupPairs);
  if (thread < VITRAIL_RASTER_CLASSES && groupCount[thread] > 0u) {
    VITRAIL_RESERVE(vitrailTileClasses.of[thread], groupCount[thread], groupList[thread])
  }
  barrier();
  if (count == 0u) return;
  vitrailTileRecords[tile].y = groupFirst + place;
  if (count > vitrailRaster.mostWalked) {
    vitrailAddDeep(tile, count);
  } else {
    vitrailTileList[kind * vitrailRaster.tilesX * vitrailRaster.tilesY + groupList[kind] + number] = tile;
  }
}
