// The second half of a pass of the method reverse-depth-peeling: the surfaces at the depth that was found are blended.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "stage/surface_light.glsl"

layout(early_fragment_tests) in;

layout(set = 2, binding = 0) uniform texture2D lastDepth;

layout(push_constant) uniform PassBlock { uint first; }; // 1: the last depth is the opaque scene's

#ifdef VITRAIL_TRANSMISSION
layout(location = 0, index = 0) out vec4 outColor;
layout(location = 0, index = 1) out vec4 outThrough;
#else
layout(location = 0) out vec4 outColor;
#endif

void main() {
  SurfaceLight layer = lightOf(shadeSurface());
  // Where nothing was found the depth is that of the near plane, and a surface there is in the picture.
  float last = texelFetch(lastDepth, ivec2(gl_FragCoord.xy), 0).r;
  if (first != 0u ? gl_FragCoord.z < last : gl_FragCoord.z <= last) discard;
  outColor = vec4(layer.color, 1.0 - layer.transmittance.a);
#ifdef VITRAIL_TRANSMISSION
  outThrough = layer.transmittance;
#endif
}
