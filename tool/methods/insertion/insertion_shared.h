// What the shaders of the method insertion and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_INSERTION_SHARED_H
#define VITRAIL_TOOL_INSERTION_SHARED_H

#include "gpu/glsl.h"

VITRAIL_SHARED_BEGIN

const uint INSERTION_LAYERS = 128u; // fragments of a pixel that are kept
const uint INSERTION_SLOTS = 64u;   // so that few work groups count in one place

// A fragment as those samples store it.
struct InsertionNode {
  uint color; // as shaders/vitrail/layout.h has them in the standard format
  uint depth;
  uint next;
};

// What some work groups have counted; as large as a cache line, so that no two share one.
struct InsertionCounts {
  uint coveredPixels;
  uint layersMax;
  uint cutPixels; // with more than INSERTION_LAYERS fragments
  uint dropped;   // fragments beyond them
  uint unused[12];
};

// All zero when the collect pass starts.
struct InsertionControl {
  uint taken; // nodes; above the pool's size where fragments found none
  uint unused[15];
  InsertionCounts counts[INSERTION_SLOTS];
};

#ifdef __cplusplus
static_assert(sizeof(InsertionNode) == 12);
static_assert(sizeof(InsertionCounts) == 64);
static_assert(sizeof(InsertionControl) == 64 + 64 * INSERTION_SLOTS);
#endif

VITRAIL_SHARED_END

#endif
