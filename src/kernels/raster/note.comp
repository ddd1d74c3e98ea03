// Keeps what a band wanted: of all bands of a frame the most. One thread.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/frame.glsl"

layout(local_size_x = 1) in;

layout(VITRAIL_RASTER_BOUND(17), std430) readonly buffer VitrailTileClassBlock { VitrailRasterTileClasses classes; };
layout(VITRAIL_RASTER_BOUND(30), std430) buffer TotalBlock { VitrailRasterTotals totals; };

// Of two numbers of two words the greater.
#define RAISE(value, high, other, otherHigh) \
  if (otherHigh > high || (otherHigh == high && other > value)) { \
    value = other; \
    high = otherHigh; \
  }

void main() {
  // Medium triangles and records astray are listed where there is room for a share of the records.
  uint records_ = vitrailRasterControl.records;
  const uint most = 0xffffffffu;
  uint mediums = vitrailRasterControl.medium;
  uint astray = vitrailRasterControl.astray;
  if (vitrailRasterControl.recordsHigh == 0u) {
    const uint share_ = vitrailIsCounted() ? 1u : VITRAIL_RASTER_MEDIUM_SHARE;
    records_ = max(records_, min(mediums, most / share_) * share_);
    records_ = max(records_, min(astray, most / VITRAIL_RASTER_ASTRAY_SHARE) * VITRAIL_RASTER_ASTRAY_SHARE);
  }
  RAISE(totals.records, totals.recordsHigh, records_, vitrailRasterControl.recordsHigh)
  RAISE(totals.fragments, totals.fragmentsHigh, vitrailRasterControl.fragments, vitrailRasterControl.fragmentsHigh)
  totals.inTiles = max(totals.inTiles, vitrailRasterControl.inTiles);
  totals.large = max(totals.large, vitrailRasterControl.large);
  totals.medium = max(totals.medium, mediums);
  totals.deep = max(totals.deep, vitrailRasterControl.deep.count);
  totals.blocks = max(totals.blocks, vitrailRasterControl.blocks.count);
  totals.chunks = max(totals.chunks, vitrailRasterControl.chunks.count);
  totals.mostFragments = max(totals.mostFragments, vitrailRasterControl.mostFragments);
  totals.wrongVertex = max(totals.wrongVertex, vitrailRasterControl.wrongVertex);
  for (uint i = 0u; i < VITRAIL_RASTER_CLASSES; ++i) {
    totals.ofClass[i] = max(totals.ofClass[i], classes.of[i].count);
  }
  totals.cutPixels += vitrailRasterControl.cutPixels;
  totals.bands += 1u;
  totals.start = vitrailRasterStart;
}
