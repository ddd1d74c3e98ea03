// loose.glsl for HLSL, which says what loose nodes are: nodes as they are collected where a compute pass builds the
// lists. To the same bits. No resources, as node.hlsl.
#ifndef VITRAIL_LOOSE_HLSL
#define VITRAIL_LOOSE_HLSL

#include "node.hlsl"

static const uint VITRAIL_PIXEL_MASK = VITRAIL_LOOSE_PIXELS - 1u;
static const float VITRAIL_COLOR_BIAS = 0.0078125; // 2^-7; its bits are 0 where those of the colour are cut out

// Whether more than the link is to be done when such a node is put on its list.
bool vitrailIsRaw(VitrailLayout nodes) {
  return VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_STANDARD) && nodes.samples == 1u;
}

// Each channel's bits stand where the fewest instructions leave them.
uint vitrailPackRawColor(float3 color) {
  precise float3 biased = min(max(color, 0.0), 1.0) + VITRAIL_COLOR_BIAS;
  uint3 bits = asuint(biased);
  return (bits.r & 0x03ff8000u) | (bits.g >> 11 & 0x00007ff0u) | ((bits.b << 10 | bits.b >> 22) & 0xfc00000fu);
}

// The middle of what is stored as the same; black and white as they are.
float3 vitrailRawColor(uint word) {
  uint3 bits = uint3(word, word << 11, word >> 10 | word << 22) & uint3(0x03ff8000u, 0x03ff8000u, 0x03ff0000u);
  uint3 middle = asuint(VITRAIL_COLOR_BIAS) + uint3(0x4000u, 0x4000u, 0x8000u);
  precise float3 color = min(asfloat(bits + middle) - VITRAIL_COLOR_BIAS, 1.0);
  return float3(bits.r == 0u ? 0.0 : color.r, bits.g == 0u ? 0.0 : color.g, bits.b == 0u ? 0.0 : color.b);
}

// In 8 bits a channel, 0 above them. `precise`: a fragment is finished where its list is built or, if it found no node,
// where it is collected, and both must give the same bits.
uint vitrailFinishColor(uint word) {
  float3 color = vitrailRawColor(word);
  precise float3 curve = 1.055 * pow(max(color, 0.0031308), 1.0 / 2.4) - 0.055;
  precise float3 low = 12.92 * color;
  precise float3 steps = vitrailMixBelow(curve, low, color, 0.0031308) * 255.0 + 8388608.0;
  uint3 q = asuint(steps) & 0xffu;
  return q.r | q.g << 8 | q.b << 16;
}

// Where vitrailIsRaw() the node of a fragment, with 0 where its pixel goes. False: it would change nothing, and is not
// stored.
bool vitrailPackRaw(float4 color, uint blend, float depth, VitrailLayout nodes, out uint4 node) {
  uint alpha = vitrailQuantize(vitrailSaturate(color), float4(255.0, 255.0, 255.0, 255.0)).a;
  uint depthWord = vitrailDepthBits(depth, nodes.nearestIsOne) | blend << 30;
  node = uint4(vitrailPackRawColor(color.rgb), depthWord, 0u, alpha << 24);
  return alpha != 0u || (blend == VITRAIL_PREMULTIPLIED && vitrailFinishColor(node.x) != 0u);
}

// As vitrailPack() would have it, of a node whose pixel has been cleared or not.
uint4 vitrailFinish(uint4 node, VitrailLayout nodes) {
  uint4 finished = uint4(node.xyz, node.w & ~vitrailNextMask(nodes));
  if (vitrailIsRaw(nodes)) finished = uint4(vitrailFinishColor(node.x) | (node.w & 0xff000000u), node.y, 0u, 0u);
  return finished;
}

#endif
