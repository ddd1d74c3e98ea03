// What the passes of the method tiles hand each other: set 3.
#ifndef VITRAIL_TOOL_TILES_FRAME_GLSL
#define VITRAIL_TOOL_TILES_FRAME_GLSL

#include "tiles_shared.h"

layout(set = 3, binding = 0, std140) uniform TilesFrameBlock { TilesFrame tiles; };
layout(set = 3, binding = 1, std430) buffer ControlBlock { TilesControl control; };
// Of each tile: how many records it has, and where its pairs begin.
layout(set = 3, binding = 2, std430) buffer TileBlock { uvec2 tileRecords[]; };
// Two for a record, which is a triangle in a tile: the pixels that it covers, the primitive (and in the highest bit
// whether its front shows) and the instance; the depth at the middle of the first pixel, what pixels to the right and
// down add, and the nearest depth.
layout(set = 3, binding = 3, std430) buffer RecordBlock { uvec4 records[]; };
// Of each record the tile (or NO_TILE), which one it is there, and its draw.
layout(set = 3, binding = 4, std430) buffer PlaceBlock { uint places[]; };
// The records of each tile: the draw, and the record.
layout(set = 3, binding = 5, std430) buffer PairBlock { uvec2 pairs[]; };
layout(set = 3, binding = 6, std430) buffer LargeBlock { uvec2 large[]; }; // primitive and instance
// Tiles by class: each has room for all.
layout(set = 3, binding = 7, std430) buffer ListBlock { uint tileList[]; };

const uint NO_TILE = 0xffffffffu;
const uint NO_FRAGMENT = 0xffffffffu; // the key of one that is hidden

// Depths to keys that grow away from the viewer. 1 is nearest.
uint keyOf(float depth) { return 0x3f800000u - floatBitsToUint(min(max(depth, 0.0), 1.0)); }

// Takes `more` work groups of an indirect dispatch in rows of TILES_ROW: the number of the first.
#define RESERVE(groups, more, first) \
  first = atomicAdd(groups.count, more); \
  atomicMax(groups.x, min(first + (more), TILES_ROW)); \
  atomicMax(groups.y, (first + (more) + TILES_ROW - 1u) / TILES_ROW); \
  groups.z = 1u;

// Takes `more` of something that is counted in two words: the number of the first. Where the lower one comes round,
// there is more than any buffer holds, and the frame is drawn again.
#define TAKE_PLACES(low, high, more, first) \
  first = atomicAdd(low, more); \
  if (first + (more) < first) atomicAdd(high, 1u);

// Whether the records can be read: no place of them was given out twice.
bool hasRecords() { return control.recordsHigh == 0u; }

// What fragments are sorted by: a depth on a record's plane in a pixel of its tile.
float depthOn(vec4 plane, ivec2 inTile) {
  return max(min(fma(plane.y, float(inTile.x), fma(plane.z, float(inTile.y), plane.x)), plane.w), 0.0);
}

// How far apart the depths of two surfaces in one plane may be at a pixel: hardware may take corners as they are or
// rounded to 1/256 pixel, and adds up what depths change by from pixel to pixel.
float depthSlack(vec4 plane, ivec2 pixel) {
  const float place = 1.0 / 480.0;
  const float rounding = 1.0 / 2097152.0;
  return rounding * abs(plane.x) + abs(plane.y) * fma(rounding, float(pixel.x), place) +
         abs(plane.z) * fma(rounding, float(pixel.y), place);
}

uint flatGroup() { return gl_WorkGroupID.y * TILES_ROW + gl_WorkGroupID.x; }

#endif
