// Brings the records of each tile together.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/frame.glsl"

layout(local_size_x = VITRAIL_RASTER_SCATTER) in;

void main() {
  uint count = vitrailHasRecords() ? min(vitrailRasterControl.records, vitrailRaster.recordCapacity) : 0u;
  uint step = gl_NumWorkGroups.x * VITRAIL_RASTER_SCATTER;
  for (uint first = gl_GlobalInvocationID.x; first < count; first += step * VITRAIL_RASTER_TOGETHER) {
    // What they wait for they wait for together.
    uvec3 places[VITRAIL_RASTER_TOGETHER];
    uint starts[VITRAIL_RASTER_TOGETHER];
    for (uint k = 0u; k < VITRAIL_RASTER_TOGETHER; ++k) {
      uint i = min(first + k * step, count - 1u);
      for (uint j = 0u; j < 3u; ++j) places[k][j] = vitrailRecordPlaces[3u * i + j];
    }
    for (uint k = 0u; k < VITRAIL_RASTER_TOGETHER; ++k) {
      bool isThere = first + k * step < count && places[k].x != VITRAIL_NO_TILE;
      if (!isThere) places[k].x = VITRAIL_NO_TILE;
      starts[k] = vitrailTileRecords[isThere ? places[k].x : 0u].y;
    }
    for (uint k = 0u; k < VITRAIL_RASTER_TOGETHER; ++k) {
      if (places[k].x != VITRAIL_NO_TILE) {
        vitrailPairs[starts[k] + places[k].y] = uvec2(places[k].z, first + k * step);
      }
    }
  }
}
