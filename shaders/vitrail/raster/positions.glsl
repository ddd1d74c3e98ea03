// Asks the host for the position of each vertex of each instance, so that this is not done again for each triangle and
// each fragment.
#ifndef VITRAIL_RASTER_POSITIONS_GLSL
#define VITRAIL_RASTER_POSITIONS_GLSL

#include "surface.glsl"

layout(local_size_x = VITRAIL_RASTER_GROUP) in;

void main() {
  uint group = vitrailFlatGroup();
  if (group >= vitrailRasterStart.vertices.count) return; // the last row is longer
  uint draw = vitrailDrawOfVertexGroup[group];
  uint vertices = vitrailDrawPlaces[draw].lookup.y;
  uvec4 size = vitrailDrawPlaces[draw].size;
  uvec4 start = vitrailDrawPlaces[draw].start;
  uint number = (group - start.x) * (VITRAIL_RASTER_GROUP * VITRAIL_RASTER_VERTICES) + gl_LocalInvocationIndex;
  for (uint i = 0u; i < VITRAIL_RASTER_VERTICES && number < vertices * size.y; ++i) {
    uint instance = number < vertices ? 0u : number / vertices;
    vitrailPositions[start.y + number] = vitrailAskPosition(draw, size.w + instance, number - instance * vertices);
    number += VITRAIL_RASTER_GROUP;
  }
}

#endif
