// What the shaders of the method insertion and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_INSERTION_SHARED_H
#define VITRAIL_TOOL_INSERTION_SHARED_H

#include "gpu/glsl.h"
#include "methods/shared/counts_shared.h"

VITRAIL_SHARED_BEGIN

const uint INSERTION_LAYERS = 128u; // fragments of a pixel that are kept

// A fragment as those samples store it.
struct InsertionNode {
  uint color; // as shaders/vitrail/layout.h has them in the standard format
  uint depth;
  uint next;
};

// All zero when the collect pass starts.
struct InsertionControl {
  uint taken; // nodes; above the pool's size where fragments found none
  uint unused[15];
  GroupCounts counts[COUNT_SLOTS]; // fragments: those beyond INSERTION_LAYERS
};

#ifdef __cplusplus
static_assert(sizeof(InsertionNode) == 12);
static_assert(sizeof(InsertionControl) == 64 + 64 * COUNT_SLOTS);
#endif

VITRAIL_SHARED_END

#endif
