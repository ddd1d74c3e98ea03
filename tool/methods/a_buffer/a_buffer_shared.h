// What the shaders of the method a-buffer and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_A_BUFFER_SHARED_H
#define VITRAIL_TOOL_A_BUFFER_SHARED_H

#include "gpu/glsl.h"

VITRAIL_SHARED_BEGIN

const uint A_BUFFER_SCAN_GROUP = 256u; // threads of a scan, which take two numbers each
const uint A_BUFFER_ROW = 32768u;      // work groups in a row of a scan's dispatch
const uint A_BUFFER_SLOTS = 64u;       // so that few work groups count in one place

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

// What some work groups have counted; as large as a cache line, so that no two share one.
struct ABufferCounts {
  uint coveredPixels;
  uint layersMax;
  uint cutPixels; // that the driver did not let the resolve finish
  uint fragments;
  uint unused[12];
};

// All zero at first.
struct ABufferControl {
  uint total; // places that the arrays of all pixels have; UINT_MAX: that or more
  uint unused[15];
  ABufferCounts counts[A_BUFFER_SLOTS];
};

#ifdef __cplusplus
static_assert(sizeof(ABufferScan) == 12);
static_assert(sizeof(ABufferResolve) == 12);
static_assert(sizeof(ABufferCounts) == 64);
static_assert(sizeof(ABufferControl) == 64 + 64 * A_BUFFER_SLOTS);
#endif

VITRAIL_SHARED_END

#endif
