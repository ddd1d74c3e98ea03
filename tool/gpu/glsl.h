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

// What the languages of Vulkan and of OpenGL (VITRAIL_OPENGL) say in different ways.
//   BOUND(set, number, opengl)   where something is bound: in Vulkan, and in OpenGL, whose numbers are one row of their
//                                own for uniform blocks, storage blocks, textures and images each. Blocks 0 to 4 are
//                                the library's; textures 0 to 15 are those of materials
//   CONSTANT(id, declaration, value)   a specialization constant; for OpenGL the host's text declares it
//   PUSHED                       the layout of a small block that changes from draw to draw: push constants
//   TEXTURE_2D, TEXTURE_2D_MS    textures without a sampler
#ifndef VITRAIL_OPENGL
#define BOUND(set_number, number, opengl) set = set_number, binding = number
#define CONSTANT(id, declaration, value) layout(constant_id = id) const declaration = value;
#define PUSHED layout(push_constant) uniform
#define TEXTURE_2D texture2D
#define TEXTURE_2D_MS texture2DMS
#else
#define BOUND(set_number, number, opengl) binding = opengl
#define CONSTANT(id, declaration, value)
#define PUSHED layout(binding = 7, std140) uniform
#define TEXTURE_2D sampler2D
#define TEXTURE_2D_MS sampler2DMS
#define gl_VertexIndex gl_VertexID
#endif
#endif

#endif
