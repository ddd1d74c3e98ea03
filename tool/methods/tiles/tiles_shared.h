// What the shaders of the method tiles and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_TILES_SHARED_H
#define VITRAIL_TOOL_TILES_SHARED_H

#include "gpu/glsl.h"
#include "methods/shared/counts_shared.h"
#include "stage/surface_shared.h"

VITRAIL_SHARED_BEGIN

const uint TILES_GROUP = 128u;            // threads of the rasteriser's work groups, a triangle each
const uint TILES_PIXELS = 64u;            // of a tile, a thread each
const uint TILES_ROW = 32768u;            // work groups in a row of a dispatch
const uint TILES_LARGE = 64u;             // a triangle that may touch more tiles is left to a pass of its own
const uint TILES_LARGE_BLOCK = 64u;       // tiles of a row that a work group of that pass looks after
const uint TILES_CLASSES = 4u;            // of tiles, by how many records they have: up to
const uint TILES_FEW = 16u;               // so many, TILES_PIXELS,
const uint TILES_SHALLOW = 256u;          // so many, and more
const uint TILES_SCATTER = 1024u;         // work groups of passes over all records
const uint TILES_BLOCK = 4096u;           // records of a deep tile that a work group looks after
const uint TILES_CHUNK = 1024u;           // fragments that a work group sorts at once
const uint TILES_SLICE = 2048u;           // fragments of a pixel that a dispatch blends
const uint TILES_TIES = 16u;              // surfaces at one depth whose order their colours decide
const float TILES_STOP = 0.35f;           // of 1/255: what may be left out of a pixel that hardly shows it
const uint TILES_CONSTANT_TEXTURES = 32u; // where only constants choose a texture (surface_of_draws.glsl)
const uint TILES_STREAMS = 6u;            // arrays of vertices (vertex_places.h)

// Instances of one mesh with one material (std430).
struct TilesDraw {
  uint firstGroup; // the first work group that sets up its triangles
  uint triangles;  // of an instance; lines or points where the features say so
  uint firstIndex;
  uint firstInstance;
  uint instances;
  uint materialNumber;
  uint features;
  uint mirrored;
  uint vertices;         // of the mesh
  uint firstCorner;      // of the first instance's vertices, if corners are kept
  uint firstCornerGroup; // the first work group that makes these
  uint drawPadding;
  uint firstWords[TILES_STREAMS];  // where its vertices begin, in words
  uint vertexWords[TILES_STREAMS]; // of a vertex; 0: all have the first
  uint textures[SLOT_COUNT];       // which of the table each slot samples
};

// A material in the scene's buffer, whose strides are those of uniform buffers.
struct TilesMaterial {
  MaterialData data;
  vec4 padding[5];
};

// What the passes of a frame share (std140).
struct TilesFrame {
  uint width; // of the picture
  uint height;
  uint tilesX;
  uint tilesY; // of the band
  uint top;    // the band's first row of pixels, and the one behind its last
  uint bottom;
  uint largeBlocks; // TILES_LARGE_BLOCKs in a row
  uint recordCapacity;
  uint largeCapacity;
  uint deepCapacity;  // deep tiles
  uint blockCapacity; // TILES_BLOCKs of them
  uint fragmentCapacity;
  uint chunkCapacity; // TILES_CHUNKs of them
  float pointSize;
  float lightMost; // that one surface sends to the eye
  uint mostWalked; // records of a tile that is not deep from the start
  uint mostVisits; // how often a tile may go through TILES_PIXELS records before it is left to others
  uint framePadding0;
  uint framePadding1;
  uint framePadding2;
  vec4 clipPlanes[CLIP_PLANE_COUNT]; // of clip space
};

// The work groups of an indirect dispatch.
struct TilesDispatch {
  uint x;
  uint y;
  uint z;
  uint count; // that there are
};

// Tiles by how many records they have. All zero at first. Apart from what is counted while they are blended.
struct TilesClasses {
  TilesDispatch of[TILES_CLASSES];
};

// What a frame counts. All zero at first.
struct TilesControl {
  TilesDispatch deep;   // tiles
  TilesDispatch blocks; // of deep tiles
  TilesDispatch chunks; // of their fragments
  uint records;         // that were wanted
  uint large;           // triangles
  uint pairs;           // records of tiles
  uint fragments;       // of deep tiles
  uint mostFragments;   // of a pixel of a deep tile
  uint cutPixels;       // that the driver did not let a pass finish
  uint recordsHigh;     // how often `records` has come round
  uint fragmentsHigh;   // the same of `fragments`
  uint controlPadding[8];
};

#ifdef __cplusplus
static_assert(sizeof(TilesDraw) == 160);
static_assert(sizeof(TilesMaterial) == 768);
static_assert(sizeof(TilesFrame) == 208);
static_assert(sizeof(TilesDispatch) == 16);
static_assert(sizeof(TilesClasses) == 64);
static_assert(sizeof(TilesControl) == 112);
#endif

VITRAIL_SHARED_END

#endif
