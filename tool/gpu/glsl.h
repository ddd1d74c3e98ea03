// What makes a header both GLSL and C++: it includes this, and what both share stands between VITRAIL_SHARED_BEGIN and
// VITRAIL_SHARED_END, in C++ in the namespace vitrail::tool::shaders.
#ifndef VITRAIL_TOOL_GLSL_H
#define VITRAIL_TOOL_GLSL_H

#ifdef __cplusplus
#include <cstdint>

namespace vitrail::tool::shaders {
using uint = std::uint32_t;
} // namespace vitrail::tool::shaders

#define VITRAIL_SHARED_BEGIN namespace vitrail::tool::shaders {
#define VITRAIL_SHARED_END }
#else
#define VITRAIL_SHARED_BEGIN
#define VITRAIL_SHARED_END
#endif

#endif
