// Transparent surfaces that are counted by the stencil: nothing is written, and what a mask cuts away is not there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stage/surface.glsl"

void main() {
  if (has(FEATURE_MASK)) shadeSurface();
}
