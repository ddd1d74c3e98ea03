// Brings records to their pages that came before these.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/pages.glsl"

layout(local_size_x = VITRAIL_RASTER_SCATTER) in;

void main() {
  uint count = vitrailHasRecords() ? vitrailRasterControl.astray : 0u;
  const uint step = gl_NumWorkGroups.x * VITRAIL_RASTER_SCATTER;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += step) {
    uint from = vitrailAstray[3u * i + 2u];
    uint to = vitrailRecordOf(vitrailAstray[3u * i], vitrailAstray[3u * i + 1u]);
    vitrailRecords[to] = vitrailRecords[from];
    vitrailRecords[vitrailRaster.recordCapacity + to] = vitrailRecords[vitrailRaster.recordCapacity + from];
    if (VITRAIL_RASTER_SAMPLES == 1u) continue;
    const uint words = VITRAIL_RASTER_SAMPLES / 2u;
    for (uint k = 0u; k < words; ++k) vitrailSampleMasks[words * to + k] = vitrailSampleMasks[words * from + k];
  }
}
