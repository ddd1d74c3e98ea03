// What the shaders that measure the depth complexity and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_COMPLEXITY_SHARED_H
#define VITRAIL_TOOL_COMPLEXITY_SHARED_H

#include "gpu/glsl.h"

VITRAIL_SHARED_BEGIN

const uint COMPLEXITY_GROUP = 256u;     // threads that take two items each to one
const uint COMPLEXITY_ROW = 32768u;     // work groups in a row of the dispatch
const uint COMPLEXITY_STENCIL = 0u;     // what a dispatch reduces: pixels' counts in the stencil,
const uint COMPLEXITY_IMAGE = 1u;       // in 32 bits,
const uint COMPLEXITY_PARTS = 2u;       // or what the dispatch before it left
const uint COMPLEXITY_SATURATED = 255u; // the largest count that a stencil holds

// What some pixels have together.
struct Complexity {
  uint deepest; // the most surfaces in one
  uint coveredPixels;
  uint deeperPixels; // with more than `nearest` surfaces
  uint surfacesLow;  // all of them
  uint surfacesHigh;
  uint keptLow; // the nearest ones
  uint keptHigh;
  uint unused;
};

struct ComplexityReduction {
  uint source;
  uint count; // of items
  uint width; // of the image
  uint from;  // the first of the items, and of the results, among the parts
  uint to;
  uint nearest; // surfaces of a pixel that are kept
};

#ifdef __cplusplus
static_assert(sizeof(Complexity) == 32);
static_assert(sizeof(ComplexityReduction) == 24);
#endif

VITRAIL_SHARED_END

#endif
