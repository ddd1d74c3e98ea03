// The tool's binding points: BOUND() of gpu/glsl.h. Those below are the library's.
#pragma once

#include <epoxy/gl.h>

namespace vitrail::tool {

// Uniform blocks.
inline constexpr GLuint kFrameBlock = 5;
inline constexpr GLuint kMaterialBlock = 6;
inline constexpr GLuint kPushedBlock = 7; // PUSHED
// Storage blocks.
inline constexpr GLuint kMethodBlock = 5; // of a method's own
inline constexpr GLuint kLightsBlock = 7;
// Textures: those of materials are 0 to 15.
inline constexpr GLuint kDepthTexture = 16;
inline constexpr GLuint kOpaqueTexture = 17;

} // namespace vitrail::tool
