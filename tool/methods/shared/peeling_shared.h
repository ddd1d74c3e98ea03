// What the shaders of the peeling methods and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_PEELING_SHARED_H
#define VITRAIL_TOOL_PEELING_SHARED_H

#include "gpu/glsl.h"

VITRAIL_SHARED_BEGIN

// Which layers a dispatch blends: the first, the others, or, when all are, what is behind them.
const uint PEELING_FIRST = 0u; // of dual-depth-peeling, whose back is the picture at first
const uint PEELING_NEXT = 1u;
const uint PEELING_LAST = 2u;

VITRAIL_SHARED_END

#endif
