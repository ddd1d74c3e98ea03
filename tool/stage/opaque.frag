// Opaque and alpha-masked surfaces: linear, premultiplied colour.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "surface.glsl"

layout(location = 0) out vec4 outColor;

void main() {
  // An infinite colour would turn into NaN where a transparent surface covers it.
  outColor = vec4(min(shadeSurface().color, LARGEST_HALF), 1.0);
}
