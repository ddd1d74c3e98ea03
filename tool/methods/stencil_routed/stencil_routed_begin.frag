// Begins a pass of the method stencil-routed: all samples of a pixel have its opaque depth.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(set = 0, binding = 0) uniform texture2D opaqueDepth;

void main() { gl_FragDepth = texelFetch(opaqueDepth, ivec2(gl_FragCoord.xy), 0).r; }
