// Gives each tile as many places for records as were counted, and begins setting up once more, which makes them.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/pages.glsl"

layout(local_size_x = 256) in;

layout(VITRAIL_RASTER_BOUND(17), std430) buffer VitrailTileClassBlock { VitrailRasterTileClasses vitrailTileClasses; };

shared uint groupRecords;
shared uint groupFirst;

void main() {
  uint thread = gl_LocalInvocationIndex;
  if (thread == 0u) groupRecords = 0u;
  barrier();
  uint tile = vitrailFlatGroup() * 256u + thread;
  uint count = tile < vitrailRaster.tilesX * vitrailRaster.tilesY ? vitrailCountIn(tile) : 0u;
  uint place = 0u;
  // The sum of a work group's tiles may come round, too.
  if (count > 0u) VITRAIL_TAKE_PLACES(groupRecords, vitrailRasterControl.recordsHigh, count, place)
  barrier();
  if (thread == 0u) {
    VITRAIL_TAKE_PLACES(vitrailRasterControl.records, vitrailRasterControl.recordsHigh, groupRecords, groupFirst)
  }
  barrier();
  if (count > 0u) {
    vitrailTiles[tile * VITRAIL_RASTER_TILE_WORDS] = 0u;
    vitrailTiles[tile * VITRAIL_RASTER_TILE_WORDS + VITRAIL_RASTER_FIRST_PAGE] = groupFirst + place;
  }
  if (tile > 0u) return;
  vitrailRasterControl.medium = vitrailRasterControl.large = 0u;
  vitrailTileClasses.medium = VitrailRasterDispatch(0u, 1u, 1u, 0u); // as begin.comp
  vitrailTileClasses.large = VitrailRasterDispatch(0u, 0u, 0u, 0u);
}
