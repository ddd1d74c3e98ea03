// What a host's transparent fragment shaders include. It binds the target's descriptor set and offers one function:
//
//   #extension GL_GOOGLE_include_directive : require
//   #define VITRAIL_SET 1
//   #include "vitrail/collect.glsl"
//   void main() { vitrailCollect(shade()); }   // linear colour, straight alpha
//
// or vitrailCollect(color, VITRAIL_ADDITIVE) and so on, see VitrailBlend; more than one call in a shader collects more
// than one fragment. vitrailCollect(color, blend, depth) takes another depth than gl_FragCoord.z. The depth test runs
// before the shader (early_fragment_tests), so fragments behind opaque geometry never enter a list. discard still
// works: call it before vitrailCollect(), or do not call vitrailCollect() at all.
//
// Where the target's nodes carry a word of the host's, vitrailCollectWord(color, word) hands one over: the number of an
// object, a material; shaders that do not store 0.
//
// Define before the include
//   VITRAIL_SET                   required: the number of the target's descriptor set, vitrailVkTargetDescriptorSet(),
//                                 in your pipeline layout
//   VITRAIL_POST_DEPTH_COVERAGE   with several samples and VK_EXT_post_depth_coverage: say the same in
//                                 VitrailVkTargetDesc
//   VITRAIL_BUFFER_REFERENCE      to reach the pool by its address, where the context has
//                                 VITRAIL_VK_FEATURE_BUFFER_DEVICE_ADDRESS. Pools larger than maxStorageBufferRange
//                                 need it. Where a shader cannot reach the pool it stores nothing, and its fragments
//                                 count as missing.
//   VITRAIL_CPU_DRIVER            for drivers that run shaders on the CPU, as Mesa's lavapipe: the same result, in a
//                                 way that suits them
//   VITRAIL_CONSTANT_ID           the first of five specialization constants, default 1700; see
//                                 vitrailVkCollectSpecialization(). The sixth is the shader's own
//
// and, to make the shader smaller where one kind of target is all that it is for, what that is. What others take is not
// in the shader then; fragments on another target count as missing, as with the specialization constants, which are
// left out.
//   VITRAIL_ONLY_FORMAT       a value of VitrailNodeFormat: 0, 1 or 2
//   VITRAIL_ONLY_SAMPLES      1, 2, 4 or 8
//   VITRAIL_ONLY_OVERFLOW     a value of VitrailOverflow: 0 or 1
//   VITRAIL_ONLY_LIST_BUILD   a value of VitrailListBuild, as vitrailVkTargetListBuild() has it: 1 or 2
//   VITRAIL_ONLY_USER_WORDS   0 or 1
#ifndef VITRAIL_COLLECT_GLSL
#define VITRAIL_COLLECT_GLSL

#ifdef VITRAIL_POST_DEPTH_COVERAGE
#extension GL_ARB_post_depth_coverage : require
#endif
#include "target.glsl"

#ifndef VITRAIL_CONSTANT_ID
#define VITRAIL_CONSTANT_ID 1700
#endif

#ifdef VITRAIL_POST_DEPTH_COVERAGE
layout(post_depth_coverage) in;
#endif
layout(early_fragment_tests) in;

// By default all are read from the target.
#ifdef VITRAIL_ONLY_FORMAT
const uint VITRAIL_NODE_FORMAT = VITRAIL_ONLY_FORMAT;
#else
VITRAIL_SPECIALIZED(VITRAIL_CONSTANT_ID) const uint VITRAIL_NODE_FORMAT = 0xffffffffu;
#endif
#ifdef VITRAIL_ONLY_SAMPLES
const uint VITRAIL_SAMPLES = VITRAIL_ONLY_SAMPLES;
#if VITRAIL_ONLY_SAMPLES != 1 && VITRAIL_ONLY_SAMPLES != 2 && VITRAIL_ONLY_SAMPLES != 4 && VITRAIL_ONLY_SAMPLES != 8
#error VITRAIL_ONLY_SAMPLES is none of 1, 2, 4 and 8
#endif
#else
VITRAIL_SPECIALIZED(VITRAIL_CONSTANT_ID + 1) const uint VITRAIL_SAMPLES = 0u;
#endif
#ifdef VITRAIL_ONLY_OVERFLOW
const uint VITRAIL_KEEP_SUMS = 1u - VITRAIL_ONLY_OVERFLOW;
#if VITRAIL_ONLY_OVERFLOW != 0 && VITRAIL_ONLY_OVERFLOW != 1
#error VITRAIL_ONLY_OVERFLOW is none of the values of VitrailOverflow
#endif
#else
#define VITRAIL_ONLY_OVERFLOW 0 // as far as code is concerned
VITRAIL_SPECIALIZED(VITRAIL_CONSTANT_ID + 2) const uint VITRAIL_KEEP_SUMS = 0xffffffffu; // 0 or 1
#endif
#ifdef VITRAIL_ONLY_LIST_BUILD
const uint VITRAIL_LOOSE = VITRAIL_ONLY_LIST_BUILD - 1u;
#if VITRAIL_ONLY_LIST_BUILD != 1 && VITRAIL_ONLY_LIST_BUILD != 2
#error VITRAIL_ONLY_LIST_BUILD is neither 1 (fragment) nor 2 (compute)
#endif
#else
#define VITRAIL_ONLY_LIST_BUILD 0
VITRAIL_SPECIALIZED(VITRAIL_CONSTANT_ID + 3) const uint VITRAIL_LOOSE = 0xffffffffu; // 0 or 1
#endif
#ifdef VITRAIL_ONLY_USER_WORDS
const uint VITRAIL_USER_WORDS = VITRAIL_ONLY_USER_WORDS;
#if VITRAIL_ONLY_USER_WORDS != 0 && VITRAIL_ONLY_USER_WORDS != 1
#error VITRAIL_ONLY_USER_WORDS is neither 0 nor 1
#endif
#else
#define VITRAIL_ONLY_USER_WORDS 1
VITRAIL_SPECIALIZED(VITRAIL_CONSTANT_ID + 4) const uint VITRAIL_USER_WORDS = 0xffffffffu; // 0 or 1
#endif

#if VITRAIL_ONLY_OVERFLOW == 0
layout(VITRAIL_BOUND(VITRAIL_SET, VITRAIL_BINDING_SUMS), std430) buffer VitrailSumsBlock { uint vitrailPixelSums[]; };
#endif
#ifdef VITRAIL_CPU_DRIVER
// The same memory again. Mesa's lavapipe waits before every draw until the draws before it are done where it sees that
// the draw's shader writes a buffer; where a binding is declared more than once, as the pool's is, it does not look.
// Draws need not wait: what they share is changed by atomics or set by all to one value, and a node has one writer.
#ifndef VITRAIL_OPENGL
VITRAIL_SPECIALIZED(VITRAIL_CONSTANT_ID + 5) const uint VITRAIL_NEVER = 0u; // no host sets it
#else
#define VITRAIL_NEVER uint(vitrailParameters.samples == 0u) // which no compiler knows
#endif
layout(VITRAIL_BOUND(VITRAIL_SET, VITRAIL_BINDING_CONTROL), std430) buffer VitrailControlAgain {
  uint vitrailControlAgain[];
};
layout(VITRAIL_BOUND(VITRAIL_SET, VITRAIL_BINDING_HEADS), std430) buffer VitrailHeadsAgain {
  uint vitrailHeadsAgain[];
};
#if VITRAIL_ONLY_OVERFLOW == 0
layout(VITRAIL_BOUND(VITRAIL_SET, VITRAIL_BINDING_SUMS), std430) buffer VitrailSumsAgain {
  uint vitrailPixelSumsAgain[];
};
#endif
#endif

#include "loose.glsl"
#if VITRAIL_ONLY_OVERFLOW == 0
#include "sums.glsl"
#endif

VitrailLayout vitrailTargetLayout() {
  return VitrailLayout(VITRAIL_NODE_FORMAT == 0xffffffffu ? vitrailParameters.format : VITRAIL_NODE_FORMAT,
                       VITRAIL_SAMPLES == 0u ? vitrailParameters.samples : VITRAIL_SAMPLES,
                       vitrailParameters.nearestIsOne != 0u);
}

bool vitrailKeepsSums() {
  return VITRAIL_KEEP_SUMS == 0xffffffffu ? vitrailParameters.keepSums != 0u : VITRAIL_KEEP_SUMS != 0u;
}

// Whether a compute pass builds the lists.
bool vitrailKeepsLoose() {
  return VITRAIL_LOOSE == 0xffffffffu ? vitrailParameters.loose != 0u : VITRAIL_LOOSE != 0u;
}

// Whether nodes carry a word of the host's.
bool vitrailKeepsWords() {
  return VITRAIL_USER_WORDS == 0xffffffffu ? vitrailParameters.userWords != 0u : VITRAIL_USER_WORDS != 0u;
}

#ifdef VITRAIL_BUFFER_REFERENCE
const uint VITRAIL_BY_ADDRESS = 1u;
#else
const uint VITRAIL_BY_ADDRESS = 0u;
#endif

#ifdef VITRAIL_POST_DEPTH_COVERAGE
const uint VITRAIL_POST_DEPTH = 1u;
#else
const uint VITRAIL_POST_DEPTH = 0u;
#endif

// The nodes that this shader may write: none where it was specialized for another target, or does not reach the pool.
uint vitrailCapacity() {
  VitrailLayout nodes = vitrailTargetLayout();
  uint number = VITRAIL_LAYOUT(nodes.format, nodes.samples, uint(vitrailKeepsSums()), uint(vitrailKeepsLoose()),
                               uint(vitrailKeepsWords()), VITRAIL_BY_ADDRESS, VITRAIL_POST_DEPTH);
  return vitrailParameters.capacities[number / 4u][number % 4u];
}

// Two flows for fragments that find no node. Their shader may not suit the target: it may have been specialized for
// another one, or not reach the pool. It writes to no memory that it does not know then, and counts what is missing.
#ifndef VITRAIL_CPU_DRIVER
// Takes a node: its index, or where there is none one from `capacity` on, which is the shader's own. Whether the shader
// suits the target is not asked before: GPUs were seen to take longer for that.
uint vitrailTakeNode(uint capacity) { return atomicAdd(vitrailControl.requested, 1u); }

// Whether this shader could write to the target's nodes, whatever else it does not suit.
bool vitrailReachesNodes() {
#ifdef VITRAIL_ONLY_FORMAT
  if (vitrailParameters.format != VITRAIL_ONLY_FORMAT) return false;
#endif
  return vitrailReachesPool();
}

// For a fragment whose shader does not suit the target. The node that it was given, if any, is left as one that changes
// nothing: who builds lists later takes all nodes, unless one of them could not be reached. Every word here costs: GPUs
// give all fragments the registers that it takes.
void vitrailTurnAway(uint index, uint pixelIndex) {
  if (index < vitrailParameters.capacity) {
    atomicAdd(vitrailControl.misfitNodes, 1u);
    if (vitrailReachesNodes()) {
      VitrailLayout target = VitrailLayout(vitrailParameters.format, vitrailParameters.samples, false);
      vitrailStoreNode(index, uvec4(0u, 0u, 0u, pixelIndex & VITRAIL_PIXEL_MASK), target);
    } else {
      vitrailControl.staleNodes = 1u;
    }
  }
}

// What else the fragment that was given this index, and no node, does for the counters. One branch round all of it,
// which compilers keep: what stands in short ones they execute for every fragment.
void vitrailCountMissing(uint index, uint pixelIndex, uint capacity) {
  bool unfit = capacity < vitrailParameters.capacity;
  if (unfit || index == VITRAIL_WRAP_AT) {
    if (index == VITRAIL_WRAP_AT) {
      atomicAdd(vitrailControl.requested, 0u - VITRAIL_WRAP_STEP);
      atomicAdd(vitrailControl.wraps, 1u);
    } else {
      vitrailTurnAway(index, pixelIndex);
    }
  }
}
#else
// For drivers that execute every branch and every loop's body once, for no fragment if need be, and are slow where
// memory is reached: a fragment whose shader does not suit the target takes no index, and there is one atomic for all
// else.
uint vitrailTakeNode(uint capacity) {
  uint index = VITRAIL_END;
  if (capacity != 0u) index = atomicAdd(vitrailControl.requested, 1u);
  return index;
}

void vitrailCountMissing(uint index, uint pixelIndex, uint capacity) {
  uint updates = index == VITRAIL_WRAP_AT ? 2u : index == VITRAIL_END ? 1u : 0u;
  for (uint i = 0u; i < updates; ++i) {
    uint word = index == VITRAIL_END ? 2u : i; // misfits, or requested and wraps
    atomicAdd(vitrailControlAgain[word], word == 0u ? 0u - VITRAIL_WRAP_STEP : 1u);
  }
}
#endif

// Adds a fragment that found no node to the sums of its pixel.
void vitrailAddMissing(uint pixelIndex, uvec4 node, uint coverage, VitrailLayout nodes) {
#if VITRAIL_ONLY_OVERFLOW == 0
#if VITRAIL_ONLY_LIST_BUILD != 1
  if (vitrailKeepsLoose()) node = vitrailFinish(node, nodes);
#endif
  float weight = float(bitCount(coverage)) / float(nodes.samples);
  VitrailSums sums = vitrailMergeFilters(vitrailSumsOf(vitrailKey(node, nodes), nodes, weight));
  uint first = pixelIndex * VITRAIL_SUM_WORDS;
  atomicAdd(vitrailPixelSums[first], sums.color.r);
  atomicAdd(vitrailPixelSums[first + 1u], sums.color.g);
  atomicAdd(vitrailPixelSums[first + 2u], sums.color.b);
  atomicAdd(vitrailPixelSums[first + 3u], sums.opacity);
  atomicAdd(vitrailPixelSums[first + 4u], sums.density);
#endif
}

// Names the declarations that are there twice, so that compilers keep them, in code that no pipeline has. They are
// changed as the first ones are, by atomics: the validation layer takes an atomic for a read, and a read of one by the
// side of a write of the other for a hazard between draws.
void vitrailKeepDeclarations() {
#ifdef VITRAIL_CPU_DRIVER
  if (VITRAIL_NEVER == 0u) return;
  atomicAdd(vitrailHeadsAgain[0], 0u);
#if VITRAIL_ONLY_OVERFLOW == 0
  atomicAdd(vitrailPixelSumsAgain[0], 0u);
#endif
#ifndef VITRAIL_BUFFER_REFERENCE
  vitrailLinks[0] = 0u; // one format may be declared alone (VITRAIL_ONLY_FORMAT)
#endif
#endif
}

// The pixel within the frame's area; beyond it, above what the area has, if it lies left of it or above.
uvec2 vitrailAreaPixel(uint samples) {
  uvec2 origin = uvec2(vitrailParameters.x, vitrailParameters.y);
  if (samples != 1u) return uvec2(gl_FragCoord.xy) - origin; // which may be where a sample is
  // Pixel centres end in .5. Adding 2^23 - 0.5 leaves the whole pixels in the low bits; a conversion is slow on GPUs.
  return floatBitsToUint(gl_FragCoord.xy + 8388607.5) - (origin + 0x4b000000u);
}

// Pushes a fragment at `depth` with this pixel's coverage on the list of its pixel. `color` is linear; `blend` is one
// of VITRAIL_OVER (straight alpha), VITRAIL_PREMULTIPLIED, VITRAIL_ADDITIVE, VITRAIL_MULTIPLY. A fragment outside the
// frame's area, or one that would change nothing, is ignored. When the pool is full the list is left as it is, and the
// fragment is counted, by the same counter that hands out nodes.
//
// `depth` is a number in [0, 1] that orders fragments as gl_FragCoord.z does. GPUs may be faster where a shader does
// not read that: with a perspective projection P, a depth range of [0, 1] and no depth bias it is also
// fma(gl_FragCoord.w, P[3][2], -P[2][2]), where P[2][3] is -1 and P[0][2], P[1][2], P[0][3], P[1][3] and P[3][3] are
// 0. With several samples only together with VITRAIL_POST_DEPTH_COVERAGE: else the resolve compares depths with those
// of the depth image.
//
// `word` is the host's, for targets whose nodes carry one; others do not look at it.
void vitrailCollect(vec4 color, uint blend, float depth, uint word) {
  vitrailKeepDeclarations();
  VitrailLayout nodes = vitrailTargetLayout();
  uvec2 pixel = vitrailAreaPixel(nodes.samples);
  if (pixel.x >= vitrailParameters.width || pixel.y >= vitrailParameters.height) return; // also those left and above
  uint coverage = nodes.samples == 1u ? 1u : uint(gl_SampleMaskIn[0]) & ((1u << nodes.samples) - 1u);
  uvec4 node;
  bool changes;
#if VITRAIL_ONLY_LIST_BUILD == 1
  changes = vitrailPack(color, blend, depth, coverage, nodes, node);
#else
  if (vitrailKeepsLoose() && vitrailIsRaw(nodes)) {
    changes = vitrailPackRaw(color, blend, depth, nodes, node);
  } else {
    changes = vitrailPack(color, blend, depth, coverage, nodes, node);
  }
#endif
  if (!changes || coverage == 0u) return;

  uint pixelIndex = pixel.y * vitrailParameters.width + pixel.x;
  uint capacity = vitrailCapacity();
  uint index = vitrailTakeNode(capacity);
  if (index >= capacity) {
    vitrailCountMissing(index, pixelIndex, capacity);
    if (vitrailKeepsSums() && vitrailParameters.keepSums != 0u) { // a shader for another target looks at both
      vitrailAddMissing(pixelIndex, node, coverage, nodes);
    }
    return;
  }
  uint next = pixelIndex;
  if (!vitrailKeepsLoose()) next = atomicExchange(vitrailHeads[pixelIndex], index);
  node.w |= next & vitrailNextMask(nodes);
  vitrailStoreNode(index, node, nodes);
#if VITRAIL_ONLY_USER_WORDS == 1
  if (vitrailKeepsWords()) vitrailStoreWord(index, word, nodes);
#endif
}

void vitrailCollect(vec4 color, uint blend, float depth) { vitrailCollect(color, blend, depth, 0u); }
void vitrailCollect(vec4 color, uint blend) { vitrailCollect(color, blend, gl_FragCoord.z); }
void vitrailCollect(vec4 color) { vitrailCollect(color, VITRAIL_OVER); }
void vitrailCollectWord(vec4 color, uint blend, uint word) { vitrailCollect(color, blend, gl_FragCoord.z, word); }
void vitrailCollectWord(vec4 color, uint word) { vitrailCollectWord(color, VITRAIL_OVER, word); }

#endif
