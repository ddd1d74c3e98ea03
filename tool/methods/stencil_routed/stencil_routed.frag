// Transparent surfaces of the method stencil-routed: what the stencil lets through is stored in the sample.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef VITRAIL_EACH_SAMPLE
#define SURFACE_IN sample in
#endif
#include "methods/shared/layer.glsl"

layout(location = 0) out vec4 outColor;
layout(location = 1) out vec4 outOpacity;
layout(location = 2) out float outDepth;

void main() {
  SurfaceLight layer = lightOf(shadeSurface());
  outColor = vec4(layer.color, 0.0);
  outOpacity = opacityOf(layer);
  outDepth = gl_FragCoord.z;
}
