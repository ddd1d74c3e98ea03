// What the shaders of the methods loop, loop-64 and interlock, and C++, share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_LAYERS_SHARED_H
#define VITRAIL_TOOL_LAYERS_SHARED_H

#include "gpu/glsl.h"

VITRAIL_SHARED_BEGIN

const uint LAYERS_EMPTY = 0xffffffffu; // the order of an entry that holds nothing: farther than any fragment
const uint LAYERS_TAIL_WORDS = 6u;     // of a pixel: the words of VitrailSums in memory, and how many fragments it has
const uint LAYERS_SLOTS = 64u;         // so that few work groups count in one place

// What some work groups have counted; as large as a cache line, so that no two share one.
struct LayersCounts {
  uint coveredPixels;
  uint layersMax;
  uint fragments;
  uint tailPixels;
  uint unused[12];
};

struct LayersControl {
  LayersCounts counts[LAYERS_SLOTS];
};

#ifdef __cplusplus
static_assert(sizeof(LayersCounts) == 64);
static_assert(sizeof(LayersControl) == 64 * LAYERS_SLOTS);
#endif

VITRAIL_SHARED_END

#endif
