// What the shaders of the rasteriser for GPUs and C++ share (vitrail/raster.glsl, vulkan_raster.h). This file is both
// GLSL and C++.
#ifndef VITRAIL_RASTER_LAYOUT_H
#define VITRAIL_RASTER_LAYOUT_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
namespace vitrail::raster {
using uint = std::uint32_t;
struct uvec4 {
  uint x, y, z, w;
};
struct vec4 {
  float x, y, z, w;
};
#endif

const uint VITRAIL_RASTER_GROUP = 128u; // threads of a work group of most passes
// Vertices for each of those that ask for positions; and where there are very many, as each work group takes its time.
const uint VITRAIL_RASTER_FEW_VERTICES = 2u;
const uint VITRAIL_RASTER_MANY_VERTICES = 8u;
const uint VITRAIL_RASTER_SET_UP = 128u;    // of one that sets up triangles, each one of them a turn
const uint VITRAIL_RASTER_FEW_MEDIUM = 16u; // medium triangles for a work group, at least, up to so many work groups
const uint VITRAIL_RASTER_MEDIUM = 1024u;
const uint VITRAIL_RASTER_PIXELS = 64u;        // of a tile, a thread each
const uint VITRAIL_RASTER_ROW = 32768u;        // work groups in a row of a dispatch
const uint VITRAIL_RASTER_LARGE = 64u;         // a triangle that may touch more tiles is left to a pass of its own
const uint VITRAIL_RASTER_LARGE_BLOCK = 64u;   // tiles of a row that a work group of that pass looks after
const uint VITRAIL_RASTER_CLASSES = 6u;        // of tiles, by how many records they have: up to
const uint VITRAIL_RASTER_FEW = 16u;           // so many, VITRAIL_RASTER_PIXELS,
const uint VITRAIL_RASTER_SHALLOW = 256u;      // so many, more; and by how deep they are in the mean: more than
const uint VITRAIL_RASTER_DEPTH = 32u;         // so many layers, and
const uint VITRAIL_RASTER_MORE_DEPTH = 64u;    // so many, or
const uint VITRAIL_RASTER_FLAT_DEPTH = 24u;    // so many of no more than VITRAIL_RASTER_PIXELS records, or
const uint VITRAIL_RASTER_SEVERAL_DEPTH = 12u; // so many with several samples
const uint VITRAIL_RASTER_SHARE = 8u;          // one record in so many is looked at for that
const uint VITRAIL_RASTER_TILE_WORDS = 32u;    // of a tile: its records, some of their pixels, and its pages
const uint VITRAIL_RASTER_FIRST_PAGE = 2u;     // of these the second page of records: 0 while there is none
const uint VITRAIL_RASTER_LEAST_PAGE = 2u;     // a tile's first page has room for 2 to the power of this, up to
const uint VITRAIL_RASTER_GOOD_PAGE = 6u;      // of this where there is memory, or of this where there are many records
const uint VITRAIL_RASTER_MOST_PAGE = 9u;
const uint VITRAIL_RASTER_MOST_PAGES = 16u;  // of a tile that is not deep: of mostWalked records, on the least pages
const uint VITRAIL_RASTER_COUNTED = 31u;     // in place of that: records are counted first, and there are no pages
const uint VITRAIL_RASTER_MEDIUM_SHARE = 4u; // medium triangles are listed, one for so many records of the room;
const uint VITRAIL_RASTER_ASTRAY_SHARE = 4u; // and records that are still to be brought to their pages
const uint VITRAIL_RASTER_BLOCK = 4096u;     // records of a deep tile that a work group looks after
const uint VITRAIL_RASTER_CHUNK = 1024u;     // fragments that a work group sorts at once
const uint VITRAIL_RASTER_SLICE = 2048u;     // fragments of a pixel that a dispatch blends
const uint VITRAIL_RASTER_TIES = 32u;        // surfaces at one depth whose order their colours decide
const uint VITRAIL_RASTER_MOST_KEPT = 32u;   // fragments of a pixel in registers
const uint VITRAIL_RASTER_TABLE = 256u;      // threads of the work groups that make the tables of a frame
const float VITRAIL_RASTER_STOP = 0.35f;     // of 1/255: what may be left out of a pixel that hardly shows it

// What a stage was compiled for: where its numbers begin in the word that the library reads in its SPIR-V, the default
// of a specialization constant (raster.glsl).
const uint VITRAIL_RASTER_COMPILED_ID = 1731u;
const uint VITRAIL_RASTER_COMPILED_STAGE = 0u;      // 3 bits
const uint VITRAIL_RASTER_COMPILED_SET = 3u;        // 4 bits
const uint VITRAIL_RASTER_COMPILED_PLANES = 7u;     // 4 bits
const uint VITRAIL_RASTER_COMPILED_FRAGMENTS = 11u; // 2 bits
const uint VITRAIL_RASTER_COMPILED_SAMPLES = 13u;   // 1 bit

// VitrailVkRasterDraw::flags (vulkan_raster.h).
const uint VITRAIL_RASTER_LINES = 1u; // else triangles
const uint VITRAIL_RASTER_POINTS = 2u;
const uint VITRAIL_RASTER_SOLID = 3u; // both bits
const uint VITRAIL_RASTER_FRONT_CLOCKWISE = 4u;
const uint VITRAIL_RASTER_CULL_FRONT = 8u;
const uint VITRAIL_RASTER_CULL_BACK = 16u;

// VitrailVkRasterDraw (std430).
struct VitrailRasterDraw {
  uint count; // of indices
  uint instances;
  uint firstIndex;
  int vertexOffset;
  uint firstInstance;
  uint vertices; // that the indices reach
  uint flags;
  uint blend;
  uint word;
  uint reserved0;
  uint reserved1;
  uint reserved2;
};

// What the other passes know of a draw (std430). The numbers of work groups, instances and vertices go on from draw to
// draw; an instance has its number among all as an item. Vectors, because GPUs load one at once: every fragment looks
// the first one up.
struct VitrailRasterPlace {
  uvec4 lookup; // firstIndex; vertices of an instance; their first place less those of the items before; firstInstance
                // less the items before
  uvec4 rest;   // vertexOffset, flags, blend, word
  uvec4 size;   // triangles of an instance, two of each line and point; instances; the first work group that sets them
                // up; the first item
  uvec4 start;  // the first work group that asks for the positions of its vertices; the first of their places
};

// What the passes of a frame share (std140). The host hands the first VITRAIL_RASTER_FRAME_WORDS to the pass `begin`.
const uint VITRAIL_RASTER_FRAME_WORDS = 28u;
struct VitrailRasterFrame {
  uint width; // of the picture
  uint height;
  uint tilesX;
  uint tilesY; // of the band
  uint top;    // the band's first row of pixels, and the one behind its last
  uint bottom;
  uint pageBits; // of the first page of each tile, or VITRAIL_RASTER_COUNTED
  uint draws;
  uint recordCapacity; // places for records
  uint largeCapacity;
  uint deepCapacity;  // deep tiles
  uint blockCapacity; // VITRAIL_RASTER_BLOCKs of them
  uint fragmentCapacity;
  uint chunkCapacity; // VITRAIL_RASTER_CHUNKs of them
  uint mostWalked;    // records of a tile that is not deep from the start
  uint mostVisits;    // how often a tile may go through VITRAIL_RASTER_PIXELS records before it is left to others
  float pointSize;
  float lightMost; // that one surface sends to the eye; negative: nobody knows
  uint groupCapacity;
  uint vertexGroupCapacity;
  uint itemCapacity;
  uint vertexCapacity;
  uint hasOrders;
  uint drawBlends;  // a bit for each blend mode that draws may have
  uint countsDraws; // the GPU has
  float depthStep;  // of the opaque depths
  uint drawCapacity;
  uint largeGroups;   // that set up large triangles, of each row of tiles
  vec4 clipPlanes[8]; // of clip space
};

// The work groups of an indirect dispatch.
struct VitrailRasterDispatch {
  uint x;
  uint y;
  uint z;
  uint count; // that there are
};

// What the passes of all bands of a frame begin with: work groups, and what there is of that a frame has once.
struct VitrailRasterStart {
  VitrailRasterDispatch tables;   // that make the tables of groups and instances
  VitrailRasterDispatch vertices; // that ask for positions
  VitrailRasterDispatch groups;   // that set up triangles
  uint items;                     // instances of all draws
  uint vertexCount;
  uint tooMany; // 1: more than numbers of 32 bits can count
  uint fits;    // 1: there was room for all of it
  // Draws that are wrong, and left out: one more than the number of the last, of each kind. 0: there is none.
  uint wrongIndices; // they end beyond the index buffer
  uint wrongBlend;   // it is none of drawBlends
};

// Tiles by how many records they have, and who sets up large triangles. All zero at first. Apart from what is counted
// meanwhile.
struct VitrailRasterTileClasses {
  VitrailRasterDispatch of[VITRAIL_RASTER_CLASSES];
  VitrailRasterDispatch medium;
  VitrailRasterDispatch large;
};

// What a band counts. All zero at first.
struct VitrailRasterControl {
  VitrailRasterDispatch deep;   // tiles
  VitrailRasterDispatch blocks; // of deep tiles
  VitrailRasterDispatch chunks; // of their fragments
  uint records;                 // places for them that were wanted
  uint large;                   // triangles
  uint inTiles;                 // records
  uint fragments;               // of deep tiles
  uint mostFragments;           // of a pixel of a deep tile
  uint cutPixels;               // that the driver did not let a pass finish
  uint recordsHigh;             // how often `records` has come round
  uint fragmentsHigh;           // the same of `fragments`
  uint wrongVertex;             // one more than the last draw that has an index of no vertex of it
  uint medium;                  // triangles
  uint astray;                  // records that came before their page
};

// What a frame wanted: of its bands the most, but cut pixels together. All zero at first.
struct VitrailRasterTotals {
  uint records;
  uint recordsHigh;
  uint large;
  uint deep;
  uint blocks;
  uint fragments;
  uint fragmentsHigh;
  uint chunks;
  uint mostFragments;
  uint cutPixels;
  uint bands; // that were drawn
  uint wrongVertex;
  uint inTiles;
  uint medium;
  uint ofClass[VITRAIL_RASTER_CLASSES]; // tiles
  VitrailRasterStart start;
};

#ifdef __cplusplus
static_assert(sizeof(VitrailRasterDraw) == 48);
static_assert(sizeof(VitrailRasterPlace) == 64);
static_assert(sizeof(VitrailRasterFrame) == 240);
static_assert(sizeof(VitrailRasterStart) == 72);
static_assert(offsetof(VitrailRasterFrame, clipPlanes) == VITRAIL_RASTER_FRAME_WORDS * sizeof(uint));
static_assert(sizeof(VitrailRasterTileClasses) == 128);
static_assert(sizeof(VitrailRasterControl) == 92);
static_assert(sizeof(VitrailRasterTotals) == 152);
} // namespace vitrail::raster
#endif

#endif
