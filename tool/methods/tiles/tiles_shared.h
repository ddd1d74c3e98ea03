// What the shaders of the method tiles and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_TILES_SHARED_H
#define VITRAIL_TOOL_TILES_SHARED_H

#include "gpu/glsl.h"
#include "stage/surface_shared.h"

VITRAIL_SHARED_BEGIN

const uint TILES_CONSTANT_TEXTURES = 32u; // where only constants choose a texture (surface_of_draws.glsl)
const uint TILES_STREAMS = 6u;            // arrays of vertices (vertex_places.h)

// What the functions of a draw look up (std430): VitrailVkRasterDraw has the rest.
struct TilesDraw {
  uint materialNumber;
  uint features;
  uint firstWords[TILES_STREAMS];  // where its vertices begin, in words
  uint vertexWords[TILES_STREAMS]; // of a vertex; 0: all have the first
  uint textures[SLOT_COUNT];       // which of the table each slot samples
};

// A material in the scene's buffer, whose strides are those of uniform buffers.
struct TilesMaterial {
  MaterialData data;
  vec4 padding[5];
};

#ifdef __cplusplus
static_assert(sizeof(TilesDraw) == 120);
static_assert(sizeof(TilesMaterial) == 768);
#endif

VITRAIL_SHARED_END

#endif
