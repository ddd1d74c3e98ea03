// What resolves count on the GPU, for shaders and C++. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_COUNTS_SHARED_H
#define VITRAIL_TOOL_COUNTS_SHARED_H

#include "gpu/glsl.h"

VITRAIL_SHARED_BEGIN

const uint COUNT_SLOTS = 64u; // so that few work groups count in one place

// What some work groups have counted; as large as a cache line, so that no two share one. All zero at first.
struct GroupCounts {
  uint coveredPixels;
  uint layersMax;
  uint cutPixels; // whose fragments were not all blended one by one
  uint fragments; // that a method counts
  uint unused[12];
};

#ifdef __cplusplus
static_assert(sizeof(GroupCounts) == 64);
#endif

VITRAIL_SHARED_END

#endif
