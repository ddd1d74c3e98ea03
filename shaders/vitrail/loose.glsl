// Nodes as they are collected where a compute pass builds the lists (VitrailListBuild): what fragment shaders spare
// themselves.
// In place of `next` they hold the number of their pixel. In `standard` at 1 sample, where `next` has 32 bits, that
// leaves 8 of them for alpha, and so 32 in another word for a colour that is not on the sRGB curve yet:
//
//   x  red in bits 15 to 25, green in 4 to 14, blue in 26 to 31 and 0 to 3, which are its higher bits
//   w  the pixel in 24 bits, alpha above it
//
// A channel is the float of value + 2^-7, of which 3 bits of exponent and the first 8 bits of fraction (blue 7) are
// kept: no more than 0.22 steps of the 8 bits on the sRGB curve (blue 0.44) are lost anywhere, so that such colours
// come through unchanged. No resources, as node.glsl.
#ifndef VITRAIL_LOOSE_GLSL
#define VITRAIL_LOOSE_GLSL

#include "node.glsl"

const uint VITRAIL_PIXEL_MASK = VITRAIL_LOOSE_PIXELS - 1u;
const float VITRAIL_COLOR_BIAS = 0.0078125; // 2^-7; its bits are 0 where those of the colour are cut out

// Whether more than the link is to be done when such a node is put on its list.
bool vitrailIsRaw(VitrailLayout nodes) { return VITRAIL_CHOOSE(nodes, nodes.samples == 1u, false, false); }

// Each channel's bits stand where the fewest instructions leave them.
uint vitrailPackRawColor(vec3 color) {
  uvec3 bits = floatBitsToUint(min(max(color, 0.0), 1.0) + VITRAIL_COLOR_BIAS);
  return (bits.r & 0x03ff8000u) | (bits.g >> 11 & 0x00007ff0u) | ((bits.b << 10 | bits.b >> 22) & 0xfc00000fu);
}

// The middle of what is stored as the same; black and white as they are.
vec3 vitrailRawColor(uint word) {
  uvec3 bits = uvec3(word, word << 11, word >> 10 | word << 22) & uvec3(0x03ff8000u, 0x03ff8000u, 0x03ff0000u);
  uvec3 middle = floatBitsToUint(VITRAIL_COLOR_BIAS) + uvec3(0x4000u, 0x4000u, 0x8000u);
  precise vec3 color = uintBitsToFloat(bits + middle) - VITRAIL_COLOR_BIAS;
  return mix(min(color, 1.0), vec3(0.0), equal(bits, uvec3(0u)));
}

// In 8 bits a channel, 0 above them. `precise`: a fragment is finished where its list is built or, if it found no node,
// where it is collected, and both must give the same bits.
uint vitrailFinishColor(uint word) {
  vec3 linear = vitrailRawColor(word);
  precise vec3 curve = 1.055 * pow(max(linear, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
  precise vec3 line = 12.92 * linear;
  precise vec3 steps = mix(curve, line, lessThanEqual(linear, vec3(0.0031308))) * 255.0 + 8388608.0;
  uvec3 q = floatBitsToUint(steps) & 0xffu;
  return q.r | q.g << 8 | q.b << 16;
}

// Where vitrailIsRaw() the node of a fragment, with 0 where its pixel goes. False: it would change nothing, and is not
// stored.
bool vitrailPackRaw(vec4 color, uint blend, float depth, VitrailLayout nodes, out uvec4 node) {
  uint alpha = vitrailQuantize(vitrailSaturate(color), vec4(255.0)).a;
  uint depthWord = vitrailDepthBits(depth, nodes.nearestIsOne) | blend << 30;
  node = uvec4(vitrailPackRawColor(color.rgb), depthWord, 0u, alpha << 24);
  return alpha != 0u || (blend == VITRAIL_PREMULTIPLIED && vitrailFinishColor(node.x) != 0u);
}

// As vitrailPack() would have it, of a node whose pixel has been cleared or not.
uvec4 vitrailFinish(uvec4 node, VitrailLayout nodes) {
  if (vitrailIsRaw(nodes)) return uvec4(vitrailFinishColor(node.x) | node.w & 0xff000000u, node.y, 0u, 0u);
  return uvec4(node.xyz, node.w & ~vitrailNextMask(nodes));
}

#endif
