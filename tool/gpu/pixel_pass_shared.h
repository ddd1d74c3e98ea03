// What the compute shaders that run once a pixel (pixel_pass.h) and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_PIXEL_PASS_SHARED_H
#define VITRAIL_TOOL_PIXEL_PASS_SHARED_H

#ifdef __cplusplus
#include <cstdint>
namespace vitrail::tool::shaders {
using uint = std::uint32_t;
#endif

const uint PIXEL_GROUP_SIDE = 8u; // of a work group, in pixels

#ifdef __cplusplus
} // namespace vitrail::tool::shaders
#endif

#endif
