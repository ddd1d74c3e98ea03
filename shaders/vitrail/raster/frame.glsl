// What the passes of the rasteriser for GPUs hand each other.
#ifndef VITRAIL_RASTER_FRAME_GLSL
#define VITRAIL_RASTER_FRAME_GLSL

#include "layout.h"

#ifndef VITRAIL_SET
#error VITRAIL_SET is not defined: the number of the raster's descriptor set, behind those of VitrailVkRasterDesc
#endif

// Specialization constants that the library sets.
layout(constant_id = 1710) const uint VITRAIL_RASTER_SAMPLES = 1u;
layout(constant_id = 1711) const bool VITRAIL_RASTER_SHUFFLES = false; // batch.glsl
layout(constant_id = 1712) const bool VITRAIL_RASTER_POSITIONS = false; // are kept
layout(constant_id = 1713) const uint VITRAIL_RASTER_KEEP = 16u; // nearest.glsl: 8, 16, 32
layout(constant_id = 1714) const uint VITRAIL_RASTER_BATCHES = 1u; // at once, 1 or 2; 0: tiles have no more than one
layout(constant_id = 1715) const uint VITRAIL_RASTER_CLASS = 0u; // of triangles
layout(constant_id = 1716) const uint VITRAIL_RASTER_BLENDS = 15u; // a bit for each that is drawn
layout(constant_id = 1717) const bool VITRAIL_RASTER_ONLY_TRIANGLES = false;
layout(constant_id = 1718) const bool VITRAIL_RASTER_NEAREST_IS_ZERO = false;
layout(constant_id = 1719) const uint VITRAIL_RASTER_INDEX_BYTES = 4u; // 2, 4, or 0: there are none
layout(constant_id = 1720) const uint VITRAIL_RASTER_TURNS = 2u; // of a work group that sets up triangles
layout(constant_id = 1721) const uint VITRAIL_RASTER_VERTICES = 2u; // for each thread that asks for positions

// What a stage does with them. A host's stages say what they only read: compilers then know that it stays as it is.
#define VITRAIL_TILES_ARE
#define VITRAIL_RECORDS_ARE
#define VITRAIL_TABLES_ARE
#ifdef VITRAIL_RASTER_STAGE
#undef VITRAIL_TABLES_ARE
#define VITRAIL_TABLES_ARE restrict readonly
#if VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_SET_UP || VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_SET_UP_LARGE
#define VITRAIL_MAKES_RECORDS
#undef VITRAIL_TILES_ARE
#define VITRAIL_TILES_ARE coherent
#else
#undef VITRAIL_TILES_ARE
#define VITRAIL_TILES_ARE restrict readonly
#undef VITRAIL_RECORDS_ARE
#define VITRAIL_RECORDS_ARE restrict readonly
#endif
#endif

#define VITRAIL_RASTER_BOUND(number) set = VITRAIL_SET, binding = number

layout(VITRAIL_RASTER_BOUND(0), std140) uniform VitrailRasterFrameBlock { VitrailRasterFrame vitrailRaster; };
layout(VITRAIL_RASTER_BOUND(1), std430) buffer VitrailRasterControlBlock { VitrailRasterControl vitrailRasterControl; };
// Of each tile VITRAIL_RASTER_TILE_WORDS: how many records it has; the pixels that one in VITRAIL_RASTER_SHARE of them
// cover; where its pages begin (pages.glsl). Setting up reads of a dispatch what it has written.
layout(VITRAIL_RASTER_BOUND(2), std430) VITRAIL_TILES_ARE buffer VitrailTileBlock { uint vitrailTiles[]; };
// Two for a record, which is a triangle in a tile: the pixels that it covers, the name of the primitive (and in the
// highest bit whether its front shows) and the item; and behind these of all records the depth at the middle of the
// first pixel, what pixels to the right and down add, and the nearest depth. Triangles that are side by side are so
// here, most often, and what GPUs write at once is then side by side as well.
layout(VITRAIL_RASTER_BOUND(3), std430) VITRAIL_RECORDS_ARE buffer VitrailRecordBlock { uvec4 vitrailRecords[]; };
// Of each record that is not on its page yet the tile, which one it is there, and where it is.
layout(VITRAIL_RASTER_BOUND(4), std430) buffer VitrailAstrayBlock { uint vitrailAstray[]; };
layout(VITRAIL_RASTER_BOUND(5), std430) buffer VitrailMediumBlock { uvec2 vitrailMedium[]; }; // name and item
layout(VITRAIL_RASTER_BOUND(6), std430) buffer VitrailLargeBlock { uvec2 vitrailLarge[]; }; // name and item
// Tiles by class, and how many records each has: each class has room for all.
layout(VITRAIL_RASTER_BOUND(7), std430) buffer VitrailTileListBlock { uvec2 vitrailTileList[]; };
// Of each record, where there are several samples, the pixels whose samples the triangle covers: samples.glsl.
layout(VITRAIL_RASTER_BOUND(19), std430) VITRAIL_RECORDS_ARE buffer VitrailSampleBlock { uvec4 vitrailSampleMasks[]; };
layout(VITRAIL_RASTER_BOUND(19), std430) readonly buffer VitrailSampleWordBlock { uint vitrailSampleWords[]; };

// The draws: places, and of each work group the draw.
layout(VITRAIL_RASTER_BOUND(21), std430) VITRAIL_TABLES_ARE
buffer VitrailDrawPlaceBlock { VitrailRasterPlace vitrailDrawPlaces[]; };
layout(VITRAIL_RASTER_BOUND(22), std430) VITRAIL_TABLES_ARE
buffer VitrailRasterStartBlock { VitrailRasterStart vitrailRasterStart; };
layout(VITRAIL_RASTER_BOUND(23), std430) VITRAIL_TABLES_ARE buffer VitrailGroupBlock { uint vitrailDrawOfGroup[]; };
layout(VITRAIL_RASTER_BOUND(24), std430) VITRAIL_TABLES_ARE
buffer VitrailVertexGroupBlock { uint vitrailDrawOfVertexGroup[]; };
// Of each item where the draw's indices begin, and the item's vertices; the draw; its instance. Fragments look it up.
layout(VITRAIL_RASTER_BOUND(25), std430) VITRAIL_TABLES_ARE buffer VitrailItemBlock { uvec4 vitrailItems[]; };
layout(VITRAIL_RASTER_BOUND(26), std430) readonly buffer VitrailIndexBlock { uint vitrailIndices[]; };
layout(VITRAIL_RASTER_BOUND(28), std430) readonly buffer VitrailOrderBlock { uint vitrailOrders[]; }; // of instances

const uint VITRAIL_NO_FRAGMENT = 0xffffffffu; // the key of one that is hidden

// Depths to keys that grow away from the viewer. 1 is nearest.
uint vitrailDistance(float depth) { return 0x3f800000u - floatBitsToUint(min(max(depth, 0.0), 1.0)); }

// Takes `more` work groups of an indirect dispatch in rows of VITRAIL_RASTER_ROW: the number of the first.
#define VITRAIL_RESERVE(groups, more, first) \
  first = atomicAdd(groups.count, more); \
  atomicMax(groups.x, min(first + (more), VITRAIL_RASTER_ROW)); \
  atomicMax(groups.y, (first + (more) + VITRAIL_RASTER_ROW - 1u) / VITRAIL_RASTER_ROW); \
  groups.z = 1u;

// Takes `more` of something that is counted in two words: the number of the first. Where the lower one comes round,
// there is more than any buffer holds, and the frame is drawn again.
#define VITRAIL_TAKE_PLACES(low, high, more, first) { \
  first = atomicAdd(low, more); \
  if (first + (more) < first) atomicAdd(high, 1u); \
}

// Whether a tile's records lie side by side, in as many places as a first turn of setting up has counted: pages.glsl.
bool vitrailIsCounted() { return vitrailRaster.pageBits == VITRAIL_RASTER_COUNTED; }

// How many medium triangles can be listed.
uint vitrailMediumCapacity() {
  return vitrailIsCounted() ? vitrailRaster.recordCapacity : vitrailRaster.recordCapacity / VITRAIL_RASTER_MEDIUM_SHARE;
}

// Whether the records can be read: there was room for all.
bool vitrailHasRecords() {
  // Of lists that were cut off each turn of setting up may have had other triangles.
  if (vitrailIsCounted() && (vitrailRasterControl.medium > vitrailMediumCapacity() ||
                             vitrailRasterControl.large > vitrailRaster.largeCapacity)) {
    return false;
  }
  return vitrailRasterControl.recordsHigh == 0u && vitrailRasterControl.records <= vitrailRaster.recordCapacity &&
         vitrailRasterControl.astray <= vitrailRaster.recordCapacity / VITRAIL_RASTER_ASTRAY_SHARE;
}

// What fragments are sorted by: a depth on a record's plane in a pixel of its tile, from 0 to 1.
float vitrailDepthOn(vec4 plane, ivec2 inTile) {
  return max(min(fma(plane.y, float(inTile.x), fma(plane.z, float(inTile.y), plane.x)), plane.w), 0.0);
}

// How far apart the depths of two surfaces in one plane may be at a pixel: hardware may take corners as they are or
// rounded to 1/256 pixel, and adds up what depths change by from pixel to pixel.
float vitrailDepthSlack(vec4 plane, ivec2 pixel) {
  const float place = 1.0 / 480.0;
  const float rounding = 1.0 / 2097152.0;
  return vitrailRaster.depthStep + rounding * abs(plane.x) + abs(plane.y) * fma(rounding, float(pixel.x), place) +
         abs(plane.z) * fma(rounding, float(pixel.y), place);
}

uint vitrailFlatGroup() { return gl_WorkGroupID.y * VITRAIL_RASTER_ROW + gl_WorkGroupID.x; }

uint vitrailFlagsOf(uint draw) { return vitrailDrawPlaces[draw].rest.y; }
uint vitrailBlendOf(uint draw) { return vitrailDrawPlaces[draw].rest.z; }
uint vitrailWordOf(uint draw) { return vitrailDrawPlaces[draw].rest.w; }
uint vitrailVertexOf(uint draw, uint index) { return index + vitrailDrawPlaces[draw].rest.x; } // as the host counts

// What a draw consists of: 3 corners a triangle, 2 a line, 1 a point. Lines and points are drawn as two triangles each.
uint vitrailCornersOf(uint flags) {
  if (VITRAIL_RASTER_ONLY_TRIANGLES) return 3u;
  uint kind = flags & VITRAIL_RASTER_SOLID;
  return kind == VITRAIL_RASTER_LINES ? 2u : kind == VITRAIL_RASTER_POINTS ? 1u : 3u;
}

// Lists and records name a primitive by where its indices begin, of those of all draws: so indices are looked up
// together with the item, and not after it. Where there are none, and with lines and points, by its number in its
// instance.
const bool VITRAIL_NAMED_BY_INDEX = VITRAIL_RASTER_ONLY_TRIANGLES && VITRAIL_RASTER_INDEX_BYTES != 0u;
uint vitrailNameOf(uint firstOfDraw, uint primitive) {
  return VITRAIL_NAMED_BY_INDEX ? firstOfDraw + 3u * primitive : primitive;
}
uint vitrailPrimitiveOf(uint firstOfDraw, uint name) {
  return VITRAIL_NAMED_BY_INDEX ? (name - firstOfDraw) / 3u : name;
}

// Where the indices of one of a draw's triangles begin.
uint vitrailFirstIndexOf(uint firstOfDraw, uint corners, uint name) {
  if (VITRAIL_NAMED_BY_INDEX) return name;
  return firstOfDraw + (corners == 3u ? 3u * name : corners * (name / 2u));
}
uint vitrailFirstIndex(uint draw, uint corners, uint name) {
  return vitrailFirstIndexOf(vitrailDrawPlaces[draw].lookup.x, corners, name);
}

// An index of a draw, without its vertexOffset.
uint vitrailIndex(uint draw, uint at) {
  if (VITRAIL_RASTER_INDEX_BYTES == 0u) return at - vitrailDrawPlaces[draw].lookup.x;
  if (VITRAIL_RASTER_INDEX_BYTES == 2u) return vitrailIndices[at >> 1] >> (16u * (at & 1u)) & 0xffffu;
  return vitrailIndices[at];
}

// Whether the draw has that vertex. Where positions are kept there is none for another, and the frame says so.
bool vitrailHasVertex(uint draw, uint index) {
  if (!VITRAIL_RASTER_POSITIONS || index < vitrailDrawPlaces[draw].lookup.y) return true;
  atomicMax(vitrailRasterControl.wrongVertex, draw + 1u);
  return false;
}

// Of an item the number of its instance.
uint vitrailInstance(uint draw, uint item) {
  return vitrailDrawPlaces[draw].lookup.w + item;
}

// The place of a vertex among all vertices of all instances.
uint vitrailVertexPlace(uint draw, uint item, uint index) {
  return vitrailDrawPlaces[draw].lookup.z + item * vitrailDrawPlaces[draw].lookup.y + index;
}

#endif
