// Packs and unpacks the `standard` node format. Pure functions: no resources.
#ifndef VITRAIL_NODE_GLSL
#define VITRAIL_NODE_GLSL

#include "layout.h"

// The IEC 61966-2-1 (sRGB) curve and its inverse.
vec3 vitrailLinearToSrgb(vec3 linear) {
  vec3 curve = 1.055 * pow(max(linear, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
  return mix(curve, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

vec3 vitrailSrgbToLinear(vec3 srgb) {
  vec3 curve = pow((max(srgb, vec3(0.04045)) + 0.055) / 1.055, vec3(2.4));
  return mix(curve, srgb / 12.92, lessThanEqual(srgb, vec3(0.04045)));
}

// Clamps to [0, 1]; a NaN becomes 0. (What clamp() does with a NaN is undefined.)
vec4 vitrailSaturate(vec4 v) { return mix(clamp(v, 0.0, 1.0), vec4(0.0), isnan(v)); }

// Linear colour and straight alpha to the node's colour word.
uint vitrailPackColor(vec4 color) {
  vec4 c = vitrailSaturate(color);
  return packUnorm4x8(vec4(vitrailLinearToSrgb(c.rgb), c.a));
}

// The node's colour word to linear colour and straight alpha.
vec4 vitrailUnpackColor(uint bits) {
  vec4 c = unpackUnorm4x8(bits);
  return vec4(vitrailSrgbToLinear(c.rgb), c.a);
}

uint vitrailAlphaBits(uint colorBits) { return colorBits >> 24; }

// gl_FragCoord.z to the node's depth word; a NaN becomes the farthest depth. Bits of floats in [0, 1] order as the floats.
uint vitrailPackDepth(float depth, bool nearestIsOne) {
  if (isnan(depth)) return nearestIsOne ? 0u : floatBitsToUint(1.0);
  return floatBitsToUint(clamp(depth, 0.0, 1.0)) & 0x7fffffffu; // -0.0 is 0.0
}

// The node's depth word to a key that grows away from the viewer.
uint vitrailDepthKey(uint depthBits, bool nearestIsOne) {
  return nearestIsOne ? floatBitsToUint(1.0) - min(depthBits, floatBitsToUint(1.0)) : depthBits;
}

#endif
