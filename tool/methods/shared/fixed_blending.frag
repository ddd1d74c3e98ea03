// Transparent surfaces for fixed-function blending: premultiplied colour. An alpha of 0 adds light and hides nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stage/surface.glsl"

layout(early_fragment_tests) in;

layout(location = 0) out vec4 outColor;

void main() {
  Surface surface = shadeSurface();
  vec3 color = min(surface.alpha * surface.color, LARGEST_HALF); // an infinite one would turn into NaN
  outColor = vec4(color, has(FEATURE_ADDITIVE) ? 0.0 : surface.alpha);
}
