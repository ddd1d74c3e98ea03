// Puts each tile on the list of its class, and brings records to their pages that came before these.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/deep.glsl"
#include "vitrail/raster/pages.glsl"

layout(local_size_x = 256) in;

layout(VITRAIL_RASTER_BOUND(17), std430) buffer VitrailTileClassBlock { VitrailRasterTileClasses vitrailTileClasses; };

shared uint groupRecords;
shared uint groupCount[VITRAIL_RASTER_CLASSES];
shared uint groupList[VITRAIL_RASTER_CLASSES];

void bringRecords() {
  uint count = vitrailHasRecords() ? vitrailRasterControl.astray : 0u;
  uint step = gl_NumWorkGroups.x * gl_NumWorkGroups.y * 256u;
  for (uint i = vitrailFlatGroup() * 256u + gl_LocalInvocationIndex; i < count; i += step) {
    uint from = vitrailAstray[3u * i + 2u];
    uint to = vitrailRecordOf(vitrailAstray[3u * i], vitrailAstray[3u * i + 1u]);
    vitrailRecords[to] = vitrailRecords[from];
    vitrailRecords[vitrailRaster.recordCapacity + to] = vitrailRecords[vitrailRaster.recordCapacity + from];
    if (VITRAIL_RASTER_SAMPLES == 1u) continue;
    const uint words = VITRAIL_RASTER_SAMPLES / 2u;
    for (uint k = 0u; k < words; ++k) vitrailSampleMasks[words * to + k] = vitrailSampleMasks[words * from + k];
  }
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint tile = vitrailFlatGroup() * 256u + thread;
  uint tiles = vitrailRaster.tilesX * vitrailRaster.tilesY;
  // Asked for before there is anything to wait for.
  uint count = tile < tiles ? vitrailCountIn(tile) : 0u;
  uint depth = tile < tiles ? vitrailTiles[tile * VITRAIL_RASTER_TILE_WORDS + 1u] : 0u;
  bringRecords();
  if (thread < VITRAIL_RASTER_CLASSES) groupCount[thread] = 0u;
  if (thread == VITRAIL_RASTER_CLASSES) groupRecords = 0u;
  barrier();
  if (count > 0u) atomicAdd(groupRecords, count);
  if (!vitrailHasRecords()) {
    if (count > 0u) vitrailTiles[tile * VITRAIL_RASTER_TILE_WORDS] = 0u; // mean.comp
    count = 0u;
  }
  uint number = 0u;
  // Of the pixels that some of the records cover: triangles.glsl.
  depth = depth * VITRAIL_RASTER_SHARE / VITRAIL_RASTER_PIXELS;
  uint most = VITRAIL_RASTER_SAMPLES > 1u      ? VITRAIL_RASTER_SEVERAL_DEPTH
              : count <= VITRAIL_RASTER_PIXELS ? VITRAIL_RASTER_FLAT_DEPTH
                                               : VITRAIL_RASTER_MORE_DEPTH;
  uint kind = count <= VITRAIL_RASTER_FEW       ? 0u
              : depth > most                    ? 5u
              : count <= VITRAIL_RASTER_PIXELS  ? 1u
              : depth > VITRAIL_RASTER_DEPTH    ? 4u
              : count <= VITRAIL_RASTER_SHALLOW ? 2u
                                                : 3u;
  if (count > 0u && count <= vitrailRaster.mostWalked) number = atomicAdd(groupCount[kind], 1u);
  barrier();
  if (thread == 0u && groupRecords > 0u) atomicAdd(vitrailRasterControl.inTiles, groupRecords);
  if (thread < VITRAIL_RASTER_CLASSES && groupCount[thread] > 0u) {
    VITRAIL_RESERVE(vitrailTileClasses.of[thread], groupCount[thread], groupList[thread])
  }
  barrier();
  if (count == 0u) return;
  if (count > vitrailRaster.mostWalked) {
    vitrailAddDeep(tile, count);
  } else {
    vitrailTileList[kind * vitrailRaster.tilesX * vitrailRaster.tilesY + groupList[kind] + number] =
        uvec2(tile, count);
  }
}
