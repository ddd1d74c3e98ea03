// What the shaders of the methods loop, loop-64 and interlock, and C++, share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_LAYERS_SHARED_H
#define VITRAIL_TOOL_LAYERS_SHARED_H

#include "gpu/glsl.h"
#include "methods/shared/counts_shared.h"

VITRAIL_SHARED_BEGIN

const uint LAYERS_EMPTY = 0xffffffffu; // the order of an entry that holds nothing: farther than any fragment
const uint LAYERS_TAIL_WORDS = 6u;     // of a pixel: the words of VitrailSums in memory, and how many fragments it has

struct LayersControl {
  GroupCounts counts[COUNT_SLOTS]; // cutPixels: that have a tail
};

#ifdef __cplusplus
static_assert(sizeof(LayersControl) == 64 * COUNT_SLOTS);
#endif

VITRAIL_SHARED_END

#endif
