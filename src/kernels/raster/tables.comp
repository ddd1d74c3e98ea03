// Makes the tables of a frame: which draw each work group is of, and what fragments look up of each item.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/frame.glsl"

layout(local_size_x = VITRAIL_RASTER_TABLE) in;

// The last draw whose first is not behind `i`: of those that have none it is never the last.
#define FIND(first, i, found) { \
  uint low = 0u; \
  uint high = vitrailRasterStart.tables.count; \
  while (high - low > 1u) { \
    uint middle = (low + high) / 2u; \
    if (vitrailDrawPlaces[middle].first <= i) low = middle; else high = middle; \
  } \
  found = low; \
}

void main() {
  if (vitrailRasterStart.fits == 0u) return;
  uint i = vitrailFlatGroup() * VITRAIL_RASTER_TABLE + gl_LocalInvocationIndex;
  if (i < vitrailRasterStart.groups.count) FIND(size.z, i, vitrailDrawOfGroup[i])
  if (i < vitrailRasterStart.vertices.count) FIND(start.x, i, vitrailDrawOfVertexGroup[i])
  if (i >= vitrailRasterStart.items) return;
  uint draw;
  FIND(size.w, i, draw)
  uvec4 lookup = vitrailDrawPlaces[draw].lookup;
  vitrailItems[i] = uvec4(lookup.x, lookup.z + i * lookup.y, draw, lookup.w + i);
}
