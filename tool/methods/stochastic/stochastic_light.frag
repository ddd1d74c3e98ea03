// The colour passes of the method stochastic: the light of the surfaces that are not hidden.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stage/surface_light.glsl"

#include "stochastic_shared.h"

layout(early_fragment_tests) in;

layout(push_constant) uniform PassBlock { StochasticPass pass; };

layout(location = 0) out vec4 outLight; // added

void main() {
  vec3 color = lightOf(shadeSurface()).color * pass.share;
  bvec3 other = notEqual(uvec3(pass.channel), uvec3(0u, 1u, 2u));
  if (pass.channel != STOCHASTIC_ALL_CHANNELS) color = mix(color, vec3(0.0), other);
  outLight = vec4(color, 0.0);
}
