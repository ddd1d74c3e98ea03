#extension GL_EXT_samplerless_texture_functions : require
#ifndef VITRAIL_TOOL_TILES_OPAQUE_DEPTH_GLSL
#define VITRAIL_TOOL_TILES_OPAQUE_DEPTH_GLSL

layout(set = 3, binding = 10) uniform texture2D depthImage;

// The nearest opaque surface's.
float opaqueDepth(ivec2 pixel) { return texelFetch(depthImage, pixel, 0).r; }

#endif
