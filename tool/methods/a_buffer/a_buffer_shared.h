// What the shaders of the method a-buffer and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_A_BUFFER_SHARED_H
#define VITRAIL_TOOL_A_BUFFER_SHARED_H

#include "gpu/glsl.h"
#include "methods/shared/counts_shared.h"

VITRAIL_SHARED_BEGIN

const uint A_BUFFER_SCAN_GROUP = 256u; // threads of a scan, which take two numbers each
const uint A_BUFFER_ROW = 32768u;      // work groups in a row of a scan's dispatch

// A step of the prefix sum over some numbers.
struct ABufferScan {
  uint count;
  uint from;   // the first of them
  uint totals; // where the sum of each work group's is
};

struct ABufferResolve {
  uint width;
  uint height;
  uint total; // where the sum of all counts is
};

// All zero at first.
struct ABufferControl {
  uint total; // places that the arrays of all pixels have; UINT_MAX: that or more
  uint unused[15];
  GroupCounts counts[COUNT_SLOTS]; // cutPixels: that the driver did not let the resolve finish
};

#ifdef __cplusplus
static_assert(sizeof(ABufferScan) == 12);
static_assert(sizeof(ABufferResolve) == 12);
static_assert(sizeof(ABufferControl) == 64 + 64 * COUNT_SLOTS);
#endif

VITRAIL_SHARED_END

#endif
