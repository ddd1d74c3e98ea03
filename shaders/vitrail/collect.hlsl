// What a host's transparent pixel shaders include: collect.glsl for HLSL, shader models 5.0 to 6.x. It binds the
// target's buffers and offers one function:
//
//   #include "vitrail/collect.hlsl"
//   [earlydepthstencil] void main(Varyings v, uint coverage : SV_Coverage) {
//     vitrailCollect(v.position, coverage, shade(v));   // SV_Position; linear colour, straight alpha
//   }
//
// or vitrailCollect(v.position, coverage, color, VITRAIL_ADDITIVE) and so on, see VitrailBlend; more than one call in a
// shader collects more than one fragment. A further argument is another depth than v.position.z. At 1 sample the
// coverage is not looked at: pass 1. The entry point has [earlydepthstencil], so that fragments behind opaque geometry
// never enter a list. discard still works: call it before vitrailCollect(), or do not call vitrailCollect() at all.
//
// Where the target's nodes carry a word of the host's, vitrailCollectWord(v.position, coverage, color, word) hands one
// over: the number of an object, a material; shaders that do not store 0.
//
// Define before the include what target.hlsl names: registers, or VITRAIL_BINDLESS. Direct3D 11 counts unordered access
// views behind the render targets: a shader's registers, u1 to u4 unless defined otherwise, are the host's choice, in
// one row, and the same as VitrailD3d11ContextDesc::uavSlot.
//
// And, to make the shader smaller where one kind of target is all that it is for, what that is. What others take is not
// in the shader then; fragments on another target count as missing.
//   VITRAIL_ONLY_FORMAT       a value of VitrailNodeFormat: 0, 1 or 2
//   VITRAIL_ONLY_SAMPLES      1, 2, 4 or 8
//   VITRAIL_ONLY_OVERFLOW     a value of VitrailOverflow: 0 or 1
//   VITRAIL_ONLY_LIST_BUILD   a value of VitrailListBuild, as the target has it: 1 or 2
//   VITRAIL_ONLY_USER_WORDS   0 or 1
//
// SV_Coverage is taken as what the primitive covers: whether the depth test has been left out of it, no device says. So
// a resolve of several samples tests them against the opaque depth.
//
// Vulkan hosts whose shaders are HLSL define VITRAIL_REGISTER_PARAMETERS=b0: then registers are the bindings of the
// target's set (docs/direct3d.md).
#ifndef VITRAIL_COLLECT_HLSL
#define VITRAIL_COLLECT_HLSL

#ifdef VITRAIL_LIST_HLSL
#error include vitrail/collect.hlsl before vitrail/list.hlsl: it writes what that one reads
#endif
#include "target.hlsl"

// By default all are read from the target.
#ifdef VITRAIL_ONLY_FORMAT
static const uint VITRAIL_NODE_FORMAT = VITRAIL_ONLY_FORMAT;
#else
#define VITRAIL_NODE_FORMAT vitrailParameters.format
#endif
#ifdef VITRAIL_ONLY_SAMPLES
static const uint VITRAIL_SAMPLES = VITRAIL_ONLY_SAMPLES;
#if VITRAIL_ONLY_SAMPLES != 1 && VITRAIL_ONLY_SAMPLES != 2 && VITRAIL_ONLY_SAMPLES != 4 && VITRAIL_ONLY_SAMPLES != 8
#error VITRAIL_ONLY_SAMPLES is none of 1, 2, 4 and 8
#endif
#else
#define VITRAIL_SAMPLES vitrailParameters.samples
#endif
#ifdef VITRAIL_ONLY_OVERFLOW
static const uint VITRAIL_KEEP_SUMS = 1u - VITRAIL_ONLY_OVERFLOW;
#if VITRAIL_ONLY_OVERFLOW != 0 && VITRAIL_ONLY_OVERFLOW != 1
#error VITRAIL_ONLY_OVERFLOW is none of the values of VitrailOverflow
#endif
#else
#define VITRAIL_ONLY_OVERFLOW 0 // as far as code is concerned
#define VITRAIL_KEEP_SUMS vitrailParameters.keepSums
#endif
#ifdef VITRAIL_ONLY_LIST_BUILD
static const uint VITRAIL_LOOSE = VITRAIL_ONLY_LIST_BUILD - 1u;
#if VITRAIL_ONLY_LIST_BUILD != 1 && VITRAIL_ONLY_LIST_BUILD != 2
#error VITRAIL_ONLY_LIST_BUILD is neither 1 (fragment) nor 2 (compute)
#endif
#else
#define VITRAIL_ONLY_LIST_BUILD 0
#define VITRAIL_LOOSE vitrailParameters.loose
#endif
#ifdef VITRAIL_ONLY_USER_WORDS
static const uint VITRAIL_USER_WORDS = VITRAIL_ONLY_USER_WORDS;
#if VITRAIL_ONLY_USER_WORDS != 0 && VITRAIL_ONLY_USER_WORDS != 1
#error VITRAIL_ONLY_USER_WORDS is neither 0 nor 1
#endif
#else
#define VITRAIL_ONLY_USER_WORDS 1
#define VITRAIL_USER_WORDS vitrailParameters.userWords
#endif

#if VITRAIL_ONLY_OVERFLOW == 0
#ifdef VITRAIL_BINDLESS
static RWByteAddressBuffer vitrailPixelSums = ResourceDescriptorHeap[vitrailIndices.sums];
#else
RWByteAddressBuffer vitrailPixelSums : VITRAIL_AT(VITRAIL_REGISTER_SUMS);
#endif
#include "sums.hlsl"
#endif
#include "loose.hlsl"

VitrailLayout vitrailTargetLayout() {
  return vitrailLayout(VITRAIL_NODE_FORMAT, VITRAIL_SAMPLES, vitrailParameters.nearestIsOne != 0u);
}

bool vitrailKeepsSums() { return VITRAIL_KEEP_SUMS != 0u; }

// Whether a compute pass builds the lists.
bool vitrailKeepsLoose() { return VITRAIL_LOOSE != 0u; }

// Whether nodes carry a word of the host's.
bool vitrailKeepsWords() { return VITRAIL_USER_WORDS != 0u; }

// The nodes that this shader may write: none where it is for another target, or does not reach the pool.
uint vitrailCapacity() {
  VitrailLayout nodes = vitrailTargetLayout();
  uint number = VITRAIL_LAYOUT(nodes.format, nodes.samples, uint(VITRAIL_KEEP_SUMS), uint(VITRAIL_LOOSE),
                               uint(VITRAIL_USER_WORDS), 0u, 0u);
  return vitrailParameters.capacities[number / 4u][number % 4u];
}

// Takes a node: its index, or where there is none one from the capacity on. Whether the shader suits the target is not
// asked before.
uint vitrailTakeNode() {
  uint index;
  vitrailControl.InterlockedAdd(VITRAIL_CONTROL_REQUESTED, 1u, index);
  return index;
}

// Whether this shader could write to the target's nodes, whatever else it does not suit.
bool vitrailReachesNodes() {
#ifdef VITRAIL_ONLY_FORMAT
  return vitrailParameters.format == VITRAIL_ONLY_FORMAT && vitrailReachesPool();
#else
  return vitrailReachesPool();
#endif
}

// For a fragment whose shader does not suit the target. The node that it was given, if any, is left as one that changes
// nothing: who builds lists later takes all nodes, unless one of them could not be reached.
void vitrailTurnAway(uint index, uint pixelIndex) {
  uint before;
  if (index < vitrailParameters.capacity) {
    vitrailControl.InterlockedAdd(VITRAIL_CONTROL_MISFIT_NODES, 1u, before);
    if (vitrailReachesNodes()) {
      VitrailLayout nodes = vitrailLayout(vitrailParameters.format, vitrailParameters.samples, false);
      vitrailStoreNode(index, uint4(0u, 0u, 0u, pixelIndex & VITRAIL_PIXEL_MASK), nodes);
    } else {
      vitrailControl.Store(VITRAIL_CONTROL_STALE_NODES, 1u);
    }
  }
}

// What else the fragment that was given this index, and no node, does for the counters.
void vitrailCountMissing(uint index, uint pixelIndex, uint capacity) {
  uint before;
  if (index == VITRAIL_WRAP_AT) {
    vitrailControl.InterlockedAdd(VITRAIL_CONTROL_REQUESTED, 0u - VITRAIL_WRAP_STEP, before);
    vitrailControl.InterlockedAdd(VITRAIL_CONTROL_WRAPS, 1u, before);
  } else if (capacity < vitrailParameters.capacity) {
    vitrailTurnAway(index, pixelIndex);
  }
}

// Adds a fragment that found no node to the sums of its pixel.
void vitrailAddMissing(uint pixelIndex, uint4 node, uint coverage, VitrailLayout nodes) {
#if VITRAIL_ONLY_OVERFLOW == 0
#if VITRAIL_ONLY_LIST_BUILD != 1
  if (vitrailKeepsLoose()) node = vitrailFinish(node, nodes);
#endif
  float weight = float(countbits(coverage)) / float(nodes.samples);
  VitrailSums sums = vitrailMergeFilters(vitrailSumsOf(vitrailKey(node, nodes), nodes, weight));
  uint first = 4u * pixelIndex * VITRAIL_SUM_WORDS;
  uint before;
  vitrailPixelSums.InterlockedAdd(first, sums.color.r, before);
  vitrailPixelSums.InterlockedAdd(first + 4u, sums.color.g, before);
  vitrailPixelSums.InterlockedAdd(first + 8u, sums.color.b, before);
  vitrailPixelSums.InterlockedAdd(first + 12u, sums.opacity, before);
  vitrailPixelSums.InterlockedAdd(first + 16u, sums.density, before);
#endif
}

// The pixel within the frame's area; beyond it, above what the area has, if it lies left of it or above.
uint2 vitrailAreaPixel(float4 position) {
  return uint2(position.xy) - uint2(vitrailParameters.x, vitrailParameters.y);
}

// Pushes a fragment at `depth` with this coverage on the list of its pixel, that of `position`. `color` is linear;
// `blend` is one of VITRAIL_OVER (straight alpha), VITRAIL_PREMULTIPLIED, VITRAIL_ADDITIVE, VITRAIL_MULTIPLY. One that
// lies outside the frame's area, or would change nothing, is ignored. When the pool is full the list is left as it is,
// and the fragment is counted, by the same counter that hands out nodes.
//
// `depth` is a number in [0, 1] that orders fragments as position.z does. Of another one only at 1 sample: with several
// the resolve compares depths with those of the depth image.
//
// `word` is the host's, for targets whose nodes carry one; others do not look at it.
void vitrailCollect(float4 position, uint coverage, float4 color, uint blend, float depth, uint word) {
  VitrailLayout nodes = vitrailTargetLayout();
  uint2 pixel = vitrailAreaPixel(position);
  if (pixel.x >= vitrailParameters.width || pixel.y >= vitrailParameters.height) return; // also those left and above
  uint covered = nodes.samples == 1u ? 1u : coverage & ((1u << nodes.samples) - 1u);
  uint4 node;
  bool changes;
#if VITRAIL_ONLY_LIST_BUILD != 1
  if (vitrailKeepsLoose() && vitrailIsRaw(nodes)) {
    changes = vitrailPackRaw(color, blend, depth, nodes, node);
  } else
#endif
  {
    changes = vitrailPack(color, blend, depth, covered, nodes, node);
  }
  if (!changes || covered == 0u) return;

  uint pixelIndex = pixel.y * vitrailParameters.width + pixel.x;
  uint capacity = vitrailCapacity();
  uint index = vitrailTakeNode();
  if (index >= capacity) {
    vitrailCountMissing(index, pixelIndex, capacity);
    if (vitrailKeepsSums() && vitrailParameters.keepSums != 0u) { // a shader for another target looks at both
      vitrailAddMissing(pixelIndex, node, covered, nodes);
    }
    return;
  }
  uint next = pixelIndex;
  if (!vitrailKeepsLoose()) vitrailHeads.InterlockedExchange(4u * pixelIndex, index, next);
  node.w |= next & vitrailNextMask(nodes);
  vitrailStoreNode(index, node, nodes);
#if VITRAIL_ONLY_USER_WORDS == 1
  if (vitrailKeepsWords()) vitrailStoreWord(index, word, nodes);
#endif
}

void vitrailCollect(float4 position, uint coverage, float4 color, uint blend, float depth) {
  vitrailCollect(position, coverage, color, blend, depth, 0u);
}
void vitrailCollect(float4 position, uint coverage, float4 color, uint blend) {
  vitrailCollect(position, coverage, color, blend, position.z);
}
void vitrailCollect(float4 position, uint coverage, float4 color) {
  vitrailCollect(position, coverage, color, VITRAIL_OVER);
}
void vitrailCollectWord(float4 position, uint coverage, float4 color, uint blend, uint word) {
  vitrailCollect(position, coverage, color, blend, position.z, word);
}
void vitrailCollectWord(float4 position, uint coverage, float4 color, uint word) {
  vitrailCollectWord(position, coverage, color, VITRAIL_OVER, word);
}

#endif
