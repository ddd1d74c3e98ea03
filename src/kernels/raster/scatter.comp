// Brings the records of each tile together.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/frame.glsl"

layout(local_size_x = 256) in;

void main() {
  uint count = vitrailHasRecords() ? min(vitrailRasterControl.records, vitrailRaster.recordCapacity) : 0u;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += VITRAIL_RASTER_SCATTER * 256u) {
    uint tile = vitrailRecordPlaces[3u * i];
    if (tile == VITRAIL_NO_TILE) continue;
    uint place = vitrailTileRecords[tile].y + vitrailRecordPlaces[3u * i + 1u];
    vitrailPairs[place] = uvec2(vitrailRecordPlaces[3u * i + 2u], i);
  }
}
