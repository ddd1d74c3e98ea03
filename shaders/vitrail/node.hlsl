// node.glsl for HLSL, shader models 5.0 to 6.x: packs and unpacks nodes in every format of layout.h, to the same bits.
// Pure functions: no resources. A node is handled as four words: `w` is always the word that holds `next`, the others
// are the format's words in order.
#ifndef VITRAIL_NODE_HLSL
#define VITRAIL_NODE_HLSL

#ifndef VITRAIL_HLSL
#define VITRAIL_HLSL
#endif
#include "layout.h"

// Where VITRAIL_ONLY_FORMAT (collect.hlsl) says which format nodes have, compilers see that what others take is not
// needed.
#ifndef VITRAIL_ONLY_FORMAT
#define VITRAIL_IS_FORMAT(nodes, number) ((nodes).format == (number))
#else
#define VITRAIL_IS_FORMAT(nodes, number) (VITRAIL_ONLY_FORMAT == (number))
#if VITRAIL_ONLY_FORMAT != 0 && VITRAIL_ONLY_FORMAT != 1 && VITRAIL_ONLY_FORMAT != 2
#error VITRAIL_ONLY_FORMAT is none of the values of VitrailNodeFormat
#endif
#endif

// How the nodes of a target are stored.
struct VitrailLayout {
  uint format;  // VITRAIL_FORMAT_*
  uint samples; // 1, 2, 4, 8
  bool nearestIsOne;
};

VitrailLayout vitrailLayout(uint format, uint samples, bool nearestIsOne) {
  VitrailLayout nodes;
  nodes.format = format;
  nodes.samples = samples;
  nodes.nearestIsOne = nearestIsOne;
  return nodes;
}

// `b` where a value is at most `limit`, else `a`: language versions differ in what ?: makes of vectors.
float3 vitrailMixBelow(float3 a, float3 b, float3 value, float limit) {
  return float3(value.x <= limit ? b.x : a.x, value.y <= limit ? b.y : a.y, value.z <= limit ? b.z : a.z);
}

// The IEC 61966-2-1 (sRGB) curve and its inverse. `precise` here and below: products and sums are not fused, as in GLSL
// they are not.
float3 vitrailLinearToSrgb(float3 color) {
  precise float3 curve = 1.055 * pow(max(color, 0.0031308), 1.0 / 2.4) - 0.055;
  precise float3 low = 12.92 * color;
  return vitrailMixBelow(curve, low, color, 0.0031308);
}

static const float VITRAIL_BY_1_055 = 0.947867334;
static const float VITRAIL_BY_12_92 = 0.0773993805;

float3 vitrailSrgbToLinear(float3 srgb) {
  precise float3 curve = pow((max(srgb, 0.04045) + 0.055) * VITRAIL_BY_1_055, 2.4);
  precise float3 low = srgb * VITRAIL_BY_12_92;
  return vitrailMixBelow(curve, low, srgb, 0.04045);
}

// min() and max() return the operand that is no NaN, so that a NaN becomes 0.
float4 vitrailSaturate(float4 v) { return min(max(v, 0.0), 1.0); }

// Values in [0, 1] to the nearest whole number of steps, at most 65535 of them. Adding 2^23 leaves a float no fraction;
// the conversion instruction is slow on GPUs.
uint4 vitrailQuantize(float4 v, float4 steps) {
  precise float4 scaled = v * steps;
  precise float4 whole = scaled + 8388608.0;
  return asuint(whole) & 0xffffu;
}

// Bits of the coverage, and of an index of the next node.
uint vitrailCoverageBits(uint samples) { return samples == 1u ? 0u : samples == 8u ? 8u : 4u; }
uint vitrailNextBits(VitrailLayout nodes) {
  return VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT) ? 24u : 32u - vitrailCoverageBits(nodes.samples);
}
// Where it is full, it ends the list: no pool has so many nodes.
uint vitrailNextMask(VitrailLayout nodes) { return 0xffffffffu >> (32u - vitrailNextBits(nodes)); }

// ---- Depth

static const uint VITRAIL_ONE = 0x3f800000u;        // the bits of 1.0
static const uint VITRAIL_DEPTH_MASK = 0x3fffffffu; // the depth word without the blend mode

// Clamps to [0, 1]; a NaN becomes the farthest depth. Both clamps are one to some compilers, which makes 0 of a NaN.
float vitrailClampDepth(float depth, bool nearestIsOne) {
  bool isNumber = (asuint(depth) & 0x7fffffffu) <= 0x7f800000u;
  float clamped = min(max(depth, 0.0), 1.0);
  return isNumber || nearestIsOne ? clamped : 1.0;
}

// Bits of floats in [0, 1] order as the floats. -0.0 is 0.0.
uint vitrailDepthBits(float depth, bool nearestIsOne) {
  return asuint(vitrailClampDepth(depth, nearestIsOne)) & VITRAIL_DEPTH_MASK;
}

// Depth bits to a key that grows away from the viewer. Its own inverse.
uint vitrailDepthKey(uint bits, bool nearestIsOne) {
  return nearestIsOne ? VITRAIL_ONE - min(bits, VITRAIL_ONE) : bits;
}

// The depth code of the compact format: a float of the distance to the far plane without sign, 5 bits of exponent, and
// what is left for the fraction.
static const uint VITRAIL_CODE_BASE = 0x30000000u; // the bits of 2^-31
uint vitrailCodeShift(uint samples) { return samples == 1u ? 12u : 14u; }
uint vitrailCodeLargest(uint samples) { return samples == 1u ? 0xffffu : 0x3fffu; }

uint vitrailDepthCode(float depth, VitrailLayout nodes) {
  float clamped = vitrailClampDepth(depth, nodes.nearestIsOne);
  uint bits = asuint(nodes.nearestIsOne ? clamped : 1.0 - clamped) & 0x7fffffffu;
  uint shift = vitrailCodeShift(nodes.samples);
  uint code = min((bits - VITRAIL_CODE_BASE + (1u << (shift - 1u))) >> shift, vitrailCodeLargest(nodes.samples));
  return bits < VITRAIL_CODE_BASE ? 0u : code;
}

// ---- Packing

// Whether a fragment with these stored values changes nothing.
bool vitrailIsNothing(uint alphaBits, uint colorBits, uint blend) {
  return alphaBits == 0u && (blend != VITRAIL_PREMULTIPLIED || colorBits == 0u);
}

bool vitrailPackCompact(float4 color, uint blend, float depth, uint coverage, VitrailLayout nodes, out uint4 node) {
  float4 c = vitrailSaturate(color);
  float4 srgb = float4(vitrailLinearToSrgb(c.rgb), c.a);
  uint code = vitrailDepthCode(depth, nodes);
  uint rgb;
  uint alpha;
  node = uint4(0u, 0u, 0u, 0u);
  if (nodes.samples == 1u) {
    uint4 q = vitrailQuantize(srgb, float4(31.0, 63.0, 31.0, 63.0));
    alpha = q.a;
    rgb = q.r | q.g << 5 | q.b << 11;
    node.x = rgb | code << 16;
    node.w = alpha << 24 | blend << 30;
  } else {
    uint4 q = vitrailQuantize(srgb, float4(31.0, 31.0, 31.0, 31.0));
    alpha = q.a;
    rgb = q.r | q.g << 5 | q.b << 10;
    node.x = rgb | (alpha & 7u) << 15 | code << 18;
    node.w = (coverage & 15u) << 24 | alpha >> 3 << 28 | blend << 30;
  }
  return !vitrailIsNothing(alpha, rgb, blend);
}

uint vitrailPackRgba8(float4 color) {
  float4 c = vitrailSaturate(color);
  uint4 q = vitrailQuantize(float4(vitrailLinearToSrgb(c.rgb), c.a), float4(255.0, 255.0, 255.0, 255.0));
  return q.r | q.g << 8 | q.b << 16 | q.a << 24;
}

// Two 16-bit floats in [0, 65504] in a word; a NaN and -0.0 are 0.
uint vitrailPackHalves(float2 v) {
  float2 c = min(max(v, 0.0), 65504.0);
  return (f32tof16(c.x) | f32tof16(c.y) << 16) & 0x7fff7fffu;
}

bool vitrailPackStandard(float4 color, uint blend, float depth, uint coverage, VitrailLayout nodes, out uint4 node) {
  uint bits = vitrailPackRgba8(color);
  node = uint4(bits, vitrailDepthBits(depth, nodes.nearestIsOne) | blend << 30, 0u, 0u);
  if (nodes.samples != 1u) node.w = coverage << vitrailNextBits(nodes);
  return !vitrailIsNothing(bits >> 24, bits & 0xffffffu, blend);
}

bool vitrailPackHdr(float4 color, uint blend, float depth, uint coverage, VitrailLayout nodes, out uint4 node) {
  uint alpha = vitrailQuantize(sqrt(vitrailSaturate(color.aaaa)), float4(65535.0, 65535.0, 65535.0, 65535.0)).a;
  uint redGreen = vitrailPackHalves(color.rg);
  uint blue = vitrailPackHalves(float2(color.b, 0.0));
  node = uint4(redGreen, blue | alpha << 16, vitrailDepthBits(depth, nodes.nearestIsOne) | blend << 30, 0u);
  if (nodes.samples != 1u) node.w = coverage << vitrailNextBits(nodes);
  return !vitrailIsNothing(alpha, redGreen | blue, blend);
}

// The node of a fragment, with 0 where the next index goes. False: it would change nothing, and is not stored.
bool vitrailPack(float4 color, uint blend, float depth, uint coverage, VitrailLayout nodes, out uint4 node) {
  bool changes;
  if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_STANDARD)) {
    changes = vitrailPackStandard(color, blend, depth, coverage, nodes, node);
  } else if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT)) {
    changes = vitrailPackCompact(color, blend, depth, coverage, nodes, node);
  } else {
    changes = vitrailPackHdr(color, blend, depth, coverage, nodes, node);
  }
  return changes;
}

// ---- Sorting keys. A key is the whole fragment in an order that grows away from the viewer, so two fragments with one
// key are the same and their order is of no consequence. Unused words are 0.

// Of the compact format: blend mode, alpha, coverage, colour, from high to low.
uint vitrailCompactRest(uint4 node, uint samples) {
  uint alpha = (node.w >> 28 & 3u) << 3 | (node.x >> 15 & 7u);
  uint several = node.w >> 30 << 24 | alpha << 19 | (node.w >> 24 & 15u) << 15 | (node.x & 0x7fffu);
  return samples == 1u ? node.w >> 24 << 16 | (node.x & 0xffffu) : several;
}

uint4 vitrailCompactKey(uint4 node, VitrailLayout nodes) {
  uint code = node.x >> (nodes.samples == 1u ? 16u : 18u);
  return uint4(vitrailCodeLargest(nodes.samples) - code, vitrailCompactRest(node, nodes.samples), 0u, 0u);
}

// Of the other two.
uint4 vitrailFullKey(uint4 node, VitrailLayout nodes) {
  bool standard = VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_STANDARD);
  uint depth = standard ? node.y : node.z;
  uint coverage = nodes.samples == 1u ? 0u : node.w >> (vitrailNextBits(nodes) & 31u);
  uint order = vitrailDepthKey(depth & VITRAIL_DEPTH_MASK, nodes.nearestIsOne) << 2 | depth >> 30;
  uint4 key = uint4(order, node.x, node.y, coverage);
  if (standard) key = uint4(order, node.x, coverage, 0u);
  return key;
}

uint4 vitrailKey(uint4 node, VitrailLayout nodes) {
  uint4 key = vitrailFullKey(node, nodes);
  if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT)) key = vitrailCompactKey(node, nodes);
  return key;
}

// ---- What a key holds

uint vitrailKeyBlend(uint4 key, VitrailLayout nodes) {
  uint compact = key.y >> (nodes.samples == 1u ? 22u : 24u);
  return VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT) ? compact : key.x & 3u;
}

// One bit a sample.
uint vitrailKeyCoverage(uint4 key, VitrailLayout nodes) {
  uint coverage = key.w;
  if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_STANDARD)) coverage = key.z;
  if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT)) coverage = key.y >> 15 & 15u;
  return nodes.samples == 1u ? 1u : coverage;
}

// The depth in a key: greater is farther away.
uint vitrailKeyDepth(uint4 key, VitrailLayout nodes) {
  return VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT) ? key.x : key.x >> 2;
}

// Colour and alpha, the colour as it is stored: linear in the hdr format, else on the sRGB curve.
// Alpha is kept as its root: faint surfaces have fine steps.
float4 vitrailHdrColor(uint4 key) {
  precise float root = float(key.z >> 16) * (1.0 / 65535.0);
  precise float alpha = root * root;
  return float4(f16tof32(key.y & 0xffffu), f16tof32(key.y >> 16), f16tof32(key.z & 0xffffu), alpha);
}

float4 vitrailCompactCurve(uint4 key, VitrailLayout nodes) {
  uint4 one = uint4(key.y, key.y >> 5, key.y >> 11, key.y >> 16) & uint4(31u, 63u, 31u, 63u);
  uint4 several = uint4(key.y, key.y >> 5, key.y >> 10, key.y >> 19) & 31u;
  precise float4 color = float4(several) * (1.0 / 31.0);
  if (nodes.samples == 1u) color = float4(one) * float4(1.0 / 31.0, 1.0 / 63.0, 1.0 / 31.0, 1.0 / 63.0);
  return color;
}

float4 vitrailStandardCurve(uint4 key) {
  precise float4 color = float4(uint4(key.y, key.y >> 8, key.y >> 16, key.y >> 24) & 255u) * (1.0 / 255.0);
  return color;
}

float4 vitrailKeyCurve(uint4 key, VitrailLayout nodes) {
  float4 color = vitrailHdrColor(key);
  if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_STANDARD)) color = vitrailStandardCurve(key);
  if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT)) color = vitrailCompactCurve(key, nodes);
  return color;
}

// The depth of a fragment, from its key.
float vitrailKeyDepthValue(uint4 key, VitrailLayout nodes) {
  uint order = vitrailKeyDepth(key, nodes);
  float depth = asfloat(vitrailDepthKey(order, nodes.nearestIsOne));
  if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT)) {
    uint code = vitrailCodeLargest(nodes.samples) - order;
    float nearness = code == 0u ? 0.0 : asfloat(VITRAIL_CODE_BASE + (code << vitrailCodeShift(nodes.samples)));
    depth = nodes.nearestIsOne ? nearness : 1.0 - nearness;
  }
  return depth;
}

// Linear colour and alpha.
float4 vitrailKeyColor(uint4 key, VitrailLayout nodes) {
  float4 c = vitrailKeyCurve(key, nodes);
  if (!VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_HDR)) c.rgb = vitrailSrgbToLinear(c.rgb);
  return c;
}

// A whole fragment, with the host's word.
VitrailLayer vitrailLayerOf(uint4 key, uint word, VitrailLayout nodes) {
  VitrailLayer layer;
  layer.color = vitrailKeyColor(key, nodes);
  layer.depth = vitrailKeyDepthValue(key, nodes);
  layer.blend = vitrailKeyBlend(key, nodes);
  layer.coverage = vitrailKeyCoverage(key, nodes);
  layer.word = word;
  return layer;
}

// What a fragment does to the light d behind it: color + transmittance * d. The fourth component is for the picture's
// alpha, whose part in `color` is 1 - transmittance.a.
struct VitrailPair {
  float3 color;
  float4 transmittance;
};

VitrailPair vitrailPairOf(float4 c, uint blend) {
  VitrailPair pair;
  precise float3 color = c.rgb * (blend == VITRAIL_PREMULTIPLIED ? 1.0 : blend == VITRAIL_MULTIPLY ? 0.0 : c.a);
  pair.color = color;
  precise float behind = 1.0 - c.a;
  float all = blend <= VITRAIL_PREMULTIPLIED ? behind : 1.0;
  pair.transmittance = float4(all, all, all, all);
  precise float3 product = c.a * c.rgb;
  precise float3 filtered = behind + product; // not lerp(), whose order is open
  if (blend == VITRAIL_MULTIPLY) pair.transmittance.rgb = filtered;
  return pair;
}

VitrailPair vitrailPairOf(VitrailLayer layer) { return vitrailPairOf(layer.color, layer.blend); }

#endif
