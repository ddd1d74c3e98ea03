// Transparent surfaces of the method weighted.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stage/surface_light.glsl"

layout(early_fragment_tests) in;

layout(push_constant) uniform Depths {
  float nearest;
  float farthest;
};

layout(location = 0) out vec4 outBody;    // added: premultiplied colour and opacity, times the weight
layout(location = 1) out vec4 outThrough; // multiplied
#ifdef FILTERS
layout(location = 2) out vec4 outGlow; // added: light that goes with hiding nothing
#endif

const float SCALE = 0.0625; // cancels: keeps sums of hundreds of layers in the range of 16-bit floats

// Equation 10 without the opacity, which `body` brings: 1 - d(z) is 1 at the nearest surface and 0 at the farthest one.
float weight() {
  float z = viewDepth();
  float near = (farthest - z) / max(farthest - nearest, 1e-30);
  if (frame.eye.w < 0.5) near *= nearest / max(z, nearest);
  near = clamp(near, 0.0, 1.0);
  return SCALE * max(1e-2, 3e3 * near * near * near);
}

void main() {
  SurfaceLight light = lightOf(shadeSurface());
  outBody = vec4(light.body, 1.0 - light.transmittance.a) * weight();
  outThrough = light.transmittance;
#ifdef FILTERS
  outGlow = vec4(light.color - light.body, 0.0);
#endif
}
