// Packs and unpacks nodes in every format of layout.h. Pure functions: no resources. A node is handled as four words:
// `w` is always the word that holds `next`, the others are the format's words in order.
#ifndef VITRAIL_NODE_GLSL
#define VITRAIL_NODE_GLSL

#include "layout.h"

// Where VITRAIL_ONLY_FORMAT (collect.glsl) says which format nodes have, what others take is not in the shader: whether
// one is possible, and expressions of one type of which the format of a VitrailLayout chooses.
#ifndef VITRAIL_ONLY_FORMAT
#define VITRAIL_MAY_BE(format) 1
#define VITRAIL_CHOOSE(nodes, standard, compact, hdr) \
  (nodes.format == VITRAIL_FORMAT_STANDARD ? (standard) : nodes.format == VITRAIL_FORMAT_COMPACT ? (compact) : (hdr))
#define VITRAIL_IF_COMPACT(nodes, compact, other) (nodes.format == VITRAIL_FORMAT_COMPACT ? (compact) : (other))
#else
#define VITRAIL_MAY_BE(format) (VITRAIL_ONLY_FORMAT == format)
#if VITRAIL_ONLY_FORMAT == 0
#define VITRAIL_CHOOSE(nodes, standard, compact, hdr) (standard)
#define VITRAIL_IF_COMPACT(nodes, compact, other) (other)
#elif VITRAIL_ONLY_FORMAT == 1
#define VITRAIL_CHOOSE(nodes, standard, compact, hdr) (compact)
#define VITRAIL_IF_COMPACT(nodes, compact, other) (compact)
#elif VITRAIL_ONLY_FORMAT == 2
#define VITRAIL_CHOOSE(nodes, standard, compact, hdr) (hdr)
#define VITRAIL_IF_COMPACT(nodes, compact, other) (other)
#else
#error VITRAIL_ONLY_FORMAT is none of the values of VitrailNodeFormat
#endif
#endif

// How the nodes of a target are stored.
struct VitrailLayout {
  uint format;  // VITRAIL_FORMAT_*
  uint samples; // 1, 2, 4, 8
  bool nearestIsOne;
};

// The IEC 61966-2-1 (sRGB) curve and its inverse.
vec3 vitrailLinearToSrgb(vec3 linear) {
  vec3 curve = 1.055 * pow(max(linear, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
  return mix(curve, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

// A fragment has to become the same numbers wherever it is composed or summed, by any API's compiler. So everything
// from a node's bits to its pair (below) is `precise`: no compiler may fuse or reorder what the other one does not. And
// it has products, not quotients: of these compilers make products or not. 1 stays 1.
const float VITRAIL_BY_1_055 = 0.947867334;
const float VITRAIL_BY_12_92 = 0.0773993805;

vec3 vitrailSrgbToLinear(vec3 srgb) {
  precise vec3 curve = pow((max(srgb, vec3(0.04045)) + 0.055) * VITRAIL_BY_1_055, vec3(2.4));
  precise vec3 line = srgb * VITRAIL_BY_12_92;
  return mix(curve, line, lessThanEqual(srgb, vec3(0.04045)));
}

// Here and below min() and max() are given what may be a NaN. Which operand they return then GLSL leaves open; GPUs and
// Mesa's CPU driver return the other one (minNum and maxNum of IEEE 754-2008), so that a NaN becomes 0. Where one did
// not, it would stay within its node. To ask with isnan() or by comparing takes a fifth of the time of packing.
vec4 vitrailSaturate(vec4 v) { return min(max(v, 0.0), 1.0); }

// Values in [0, 1] to the nearest whole number of steps, at most 65535 of them. Adding 2^23 leaves a float no fraction;
// the conversion instruction is slow on GPUs.
uvec4 vitrailQuantize(vec4 v, vec4 steps) { return floatBitsToUint(v * steps + 8388608.0) & 0xffffu; }

// Bits of the coverage, and of an index of the next node.
uint vitrailCoverageBits(uint samples) { return samples == 1u ? 0u : samples == 8u ? 8u : 4u; }
uint vitrailNextBits(VitrailLayout nodes) {
  return VITRAIL_IF_COMPACT(nodes, 24u, 32u - vitrailCoverageBits(nodes.samples));
}
// Where it is full, it ends the list: no pool has so many nodes.
uint vitrailNextMask(VitrailLayout nodes) { return 0xffffffffu >> (32u - vitrailNextBits(nodes)); }

// ---- Depth

const uint VITRAIL_ONE = 0x3f800000u;        // the bits of 1.0
const uint VITRAIL_DEPTH_MASK = 0x3fffffffu; // the depth word without the blend mode

// Clamps to [0, 1]; a NaN becomes the farthest depth.
float vitrailClampDepth(float depth, bool nearestIsOne) {
  return nearestIsOne ? min(max(depth, 0.0), 1.0) : max(min(depth, 1.0), 0.0);
}

// Bits of floats in [0, 1] order as the floats. -0.0 is 0.0.
uint vitrailDepthBits(float depth, bool nearestIsOne) {
  return floatBitsToUint(vitrailClampDepth(depth, nearestIsOne)) & VITRAIL_DEPTH_MASK;
}

// Depth bits to a key that grows away from the viewer. Its own inverse.
uint vitrailDepthKey(uint bits, bool nearestIsOne) {
  return nearestIsOne ? VITRAIL_ONE - min(bits, VITRAIL_ONE) : bits;
}

// The depth code of the compact format: a float of the distance to the far plane without sign, 5 bits of exponent, and
// what is left for the fraction.
const uint VITRAIL_CODE_BASE = 0x30000000u; // the bits of 2^-31
uint vitrailCodeShift(uint samples) { return samples == 1u ? 12u : 14u; }
uint vitrailCodeLargest(uint samples) { return samples == 1u ? 0xffffu : 0x3fffu; }

uint vitrailDepthCode(float depth, VitrailLayout nodes) {
  float clamped = vitrailClampDepth(depth, nodes.nearestIsOne);
  uint bits = floatBitsToUint(nodes.nearestIsOne ? clamped : 1.0 - clamped) & 0x7fffffffu;
  if (bits < VITRAIL_CODE_BASE) return 0u;
  uint shift = vitrailCodeShift(nodes.samples);
  return min((bits - VITRAIL_CODE_BASE + (1u << (shift - 1u))) >> shift, vitrailCodeLargest(nodes.samples));
}

// ---- Packing

// Whether a fragment with these stored values changes nothing.
bool vitrailIsNothing(uint alphaBits, uint colorBits, uint blend) {
  return alphaBits == 0u && (blend != VITRAIL_PREMULTIPLIED || colorBits == 0u);
}

bool vitrailPackCompact(vec4 color, uint blend, float depth, uint coverage, VitrailLayout nodes, out uvec4 node) {
  vec4 c = vitrailSaturate(color);
  vec3 srgb = vitrailLinearToSrgb(c.rgb);
  uint code = vitrailDepthCode(depth, nodes);
  bool single = nodes.samples == 1u;
  uvec4 q = vitrailQuantize(vec4(srgb, c.a), single ? vec4(31.0, 63.0, 31.0, 63.0) : vec4(31.0));
  uint alpha = q.a;
  uint rgb = q.r | q.g << 5 | q.b << (single ? 11 : 10);
  node = uvec4(0u);
  node.x = single ? rgb | code << 16 : rgb | (alpha & 7u) << 15 | code << 18;
  node.w = (single ? alpha << 24 : (coverage & 15u) << 24 | alpha >> 3 << 28) | blend << 30;
  return !vitrailIsNothing(alpha, rgb, blend);
}

uint vitrailPackRgba8(vec4 color) {
  vec4 c = vitrailSaturate(color);
  uvec4 q = vitrailQuantize(vec4(vitrailLinearToSrgb(c.rgb), c.a), vec4(255.0));
  return q.r | q.g << 8 | q.b << 16 | q.a << 24;
}

// Two 16-bit floats in [0, 65504] in a word; a NaN and -0.0 are 0.
uint vitrailPackHalves(vec2 v) {
  return packHalf2x16(min(max(v, 0.0), 65504.0)) & 0x7fff7fffu;
}

#if VITRAIL_MAY_BE(0) || VITRAIL_MAY_BE(2)
// Of the other two.
bool vitrailPackFull(vec4 color, uint blend, float depth, uint coverage, VitrailLayout nodes, out uvec4 node) {
  uint depthWord = vitrailDepthBits(depth, nodes.nearestIsOne) | blend << 30;
  uint coverageWord = nodes.samples == 1u ? 0u : coverage << vitrailNextBits(nodes);
#if VITRAIL_MAY_BE(0)
#if VITRAIL_MAY_BE(2)
  if (nodes.format == VITRAIL_FORMAT_STANDARD)
#endif
  {
    uint bits = vitrailPackRgba8(color);
    node = uvec4(bits, depthWord, 0u, coverageWord);
    return !vitrailIsNothing(bits >> 24, bits & 0xffffffu, blend);
  }
#endif
#if VITRAIL_MAY_BE(2)
  uint alpha = vitrailQuantize(sqrt(vitrailSaturate(color.aaaa)), vec4(65535.0)).a;
  uint redGreen = vitrailPackHalves(color.rg);
  uint blue = vitrailPackHalves(vec2(color.b, 0.0));
  node = uvec4(redGreen, blue | alpha << 16, depthWord, coverageWord);
  return !vitrailIsNothing(alpha, redGreen | blue, blend);
#endif
}
#endif

// The node of a fragment, with 0 where the next index goes. False: it would change nothing, and is not stored.
bool vitrailPack(vec4 color, uint blend, float depth, uint coverage, VitrailLayout nodes, out uvec4 node) {
  return VITRAIL_IF_COMPACT(nodes, vitrailPackCompact(color, blend, depth, coverage, nodes, node),
                            vitrailPackFull(color, blend, depth, coverage, nodes, node));
}

// ---- Sorting keys. A key is the whole fragment in an order that grows away from the viewer, so two fragments with one
// key are the same and their order is of no consequence. Unused words are 0.

// Of the compact format: blend mode, alpha, coverage, colour, from high to low.
uint vitrailCompactRest(uvec4 node, uint samples) {
  if (samples == 1u) return node.w >> 24 << 16 | (node.x & 0xffffu);
  uint alpha = (node.w >> 28 & 3u) << 3 | (node.x >> 15 & 7u);
  return node.w >> 30 << 24 | alpha << 19 | (node.w >> 24 & 15u) << 15 | (node.x & 0x7fffu);
}

uvec4 vitrailCompactKey(uvec4 node, VitrailLayout nodes) {
  uint code = node.x >> (nodes.samples == 1u ? 16 : 18);
  return uvec4(vitrailCodeLargest(nodes.samples) - code, vitrailCompactRest(node, nodes.samples), 0u, 0u);
}

// Of the other two.
uvec4 vitrailFullKey(uvec4 node, VitrailLayout nodes) {
  uint depth = VITRAIL_CHOOSE(nodes, node.y, 0u, node.z);
  uint coverage = nodes.samples == 1u ? 0u : node.w >> vitrailNextBits(nodes);
  uint order = vitrailDepthKey(depth & VITRAIL_DEPTH_MASK, nodes.nearestIsOne) << 2 | depth >> 30;
  return VITRAIL_CHOOSE(nodes, uvec4(order, node.x, coverage, 0u), uvec4(0u), uvec4(order, node.xy, coverage));
}

uvec4 vitrailKey(uvec4 node, VitrailLayout nodes) {
  return VITRAIL_IF_COMPACT(nodes, vitrailCompactKey(node, nodes), vitrailFullKey(node, nodes));
}

// ---- What a key holds

uint vitrailKeyBlend(uvec4 key, VitrailLayout nodes) {
  return VITRAIL_IF_COMPACT(nodes, key.y >> (nodes.samples == 1u ? 22 : 24), key.x & 3u);
}

// One bit a sample.
uint vitrailKeyCoverage(uvec4 key, VitrailLayout nodes) {
  if (nodes.samples == 1u) return 1u;
  return VITRAIL_CHOOSE(nodes, key.z, key.y >> 15 & 15u, key.w);
}

// The depth in a key, and that of any point rounded as a fragment's would be: greater is farther away.
uint vitrailKeyDepth(uvec4 key, VitrailLayout nodes) {
  return nodes.format == VITRAIL_FORMAT_COMPACT ? key.x : key.x >> 2;
}
uint vitrailDepthOrder(float depth, VitrailLayout nodes) {
  if (nodes.format == VITRAIL_FORMAT_COMPACT) return vitrailCodeLargest(nodes.samples) - vitrailDepthCode(depth, nodes);
  return vitrailDepthKey(vitrailDepthBits(depth, nodes.nearestIsOne), nodes.nearestIsOne);
}

// Colour and alpha, the colour as it is stored: linear in the hdr format, else on the sRGB curve.
// Alpha is kept as its root: faint surfaces have fine steps.
vec4 vitrailHdrColor(uvec4 key) {
  precise float root = float(key.z >> 16) * (1.0 / 65535.0);
  precise float alpha = root * root;
  return vec4(unpackHalf2x16(key.y), unpackHalf2x16(key.z & 0xffffu).x, alpha);
}

vec4 vitrailCompactCurve(uvec4 key, VitrailLayout nodes) {
  if (nodes.samples == 1u) {
    const uvec4 steps = uvec4(31u, 63u, 31u, 63u);
    const vec4 step = vec4(1.0 / 31.0, 1.0 / 63.0, 1.0 / 31.0, 1.0 / 63.0);
    precise vec4 color = vec4(uvec4(key.y, key.y >> 5, key.y >> 11, key.y >> 16) & steps) * step;
    return color;
  }
  precise vec4 color = vec4(uvec4(key.y, key.y >> 5, key.y >> 10, key.y >> 19) & 31u) * (1.0 / 31.0);
  return color;
}

vec4 vitrailStandardCurve(uvec4 key) {
  precise vec4 color = vec4(uvec4(key.y, key.y >> 8, key.y >> 16, key.y >> 24) & 255u) * (1.0 / 255.0);
  return color;
}

vec4 vitrailKeyCurve(uvec4 key, VitrailLayout nodes) {
  return VITRAIL_CHOOSE(nodes, vitrailStandardCurve(key), vitrailCompactCurve(key, nodes), vitrailHdrColor(key));
}

// The depth of a fragment, from its key.
float vitrailKeyDepthValue(uvec4 key, VitrailLayout nodes) {
  uint order = vitrailKeyDepth(key, nodes);
  if (nodes.format != VITRAIL_FORMAT_COMPACT) return uintBitsToFloat(vitrailDepthKey(order, nodes.nearestIsOne));
  uint code = vitrailCodeLargest(nodes.samples) - order;
  float nearness = code == 0u ? 0.0 : uintBitsToFloat(VITRAIL_CODE_BASE + (code << vitrailCodeShift(nodes.samples)));
  return nodes.nearestIsOne ? nearness : 1.0 - nearness;
}

// Linear colour and alpha.
vec4 vitrailKeyColor(uvec4 key, VitrailLayout nodes) {
  vec4 c = vitrailKeyCurve(key, nodes);
  return nodes.format == VITRAIL_FORMAT_HDR ? c : vec4(vitrailSrgbToLinear(c.rgb), c.a);
}

// A whole fragment, with the host's word.
VitrailLayer vitrailLayerOf(uvec4 key, uint word, VitrailLayout nodes) {
  return VitrailLayer(vitrailKeyColor(key, nodes), vitrailKeyDepthValue(key, nodes), vitrailKeyBlend(key, nodes),
                      vitrailKeyCoverage(key, nodes), word);
}

// What a fragment does to the light d behind it: color + transmittance * d. The fourth component is for the picture's
// alpha, whose part in `color` is 1 - transmittance.a.
struct VitrailPair {
  vec3 color;
  vec4 transmittance;
};

VitrailPair vitrailPairOf(vec4 c, uint blend) {
  bool multiplies = blend == VITRAIL_MULTIPLY;
  VitrailPair pair;
  precise vec3 color = c.rgb * mix(mix(c.a, 0.0, multiplies), 1.0, blend == VITRAIL_PREMULTIPLIED);
  precise float behind = 1.0 - c.a;
  precise vec3 filtered = behind + c.a * c.rgb; // mix() leaves it open in which order
  pair.color = color;
  pair.transmittance = vec4(mix(1.0, behind, blend <= VITRAIL_PREMULTIPLIED));
  pair.transmittance.rgb = mix(pair.transmittance.rgb, filtered, bvec3(multiplies));
  return pair;
}

VitrailPair vitrailPairOf(uvec4 key, VitrailLayout nodes) {
  return vitrailPairOf(vitrailKeyColor(key, nodes), vitrailKeyBlend(key, nodes));
}
VitrailPair vitrailPairOf(VitrailLayer layer) { return vitrailPairOf(layer.color, layer.blend); }

#endif
