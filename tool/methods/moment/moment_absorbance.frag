// The first pass of the method moment: how much surfaces absorb, and where.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stage/surface_light.glsl"

#include "moments.glsl"

layout(early_fragment_tests) in;

layout(location = 0) out vec4 outMoments; // added
layout(location = 1) out vec4 outTotal;   // added
#ifdef FILTERS
layout(location = 2) out vec4 outThrough; // multiplied
#endif

void main() {
  SurfaceLight light = lightOf(shadeSurface());
  float total = absorbance(light.transmittance.rgb);
  outMoments = total * powers(warpedDepth(viewDepth()));
  outTotal = vec4(total);
#ifdef FILTERS
  outThrough = light.transmittance;
#endif
}
