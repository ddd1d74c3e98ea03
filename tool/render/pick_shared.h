// What picking on a GPU shares between C++ and GLSL. This file is both.
#ifndef VITRAIL_TOOL_PICK_SHARED_H
#define VITRAIL_TOOL_PICK_SHARED_H

#include "gpu/glsl.h"

VITRAIL_SHARED_BEGIN

// The word of a fragment: the number of the instance that it is of, and this bit where that is opaque.
const uint PICK_OPAQUE = 0x80000000u;

const uint PICK_MOST_LAYERS = 16384u; // of a pixel that are told

VITRAIL_SHARED_END

#endif
