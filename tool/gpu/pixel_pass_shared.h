// What the compute shaders that run once a pixel (pixel_pass.h) and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_PIXEL_PASS_SHARED_H
#define VITRAIL_TOOL_PIXEL_PASS_SHARED_H

#include "gpu/glsl.h"

VITRAIL_SHARED_BEGIN

const uint PIXEL_GROUP_SIDE = 8u; // of a work group, in pixels

#ifdef __cplusplus
// The work groups along a side of so many pixels.
constexpr uint pixelGroups(uint pixels) { return (pixels + PIXEL_GROUP_SIDE - 1) / PIXEL_GROUP_SIDE; }
#endif

VITRAIL_SHARED_END

#endif
