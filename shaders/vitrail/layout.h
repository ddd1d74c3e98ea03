// The structures that shaders and C++ share. This file is GLSL, HLSL (VITRAIL_HLSL) and C++: it stands once, C++
// asserts the sizes below, and a test reads the strides and offsets of the compiled SPIR-V.
#ifndef VITRAIL_LAYOUT_H
#define VITRAIL_LAYOUT_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
namespace vitrail::layout {
using uint = std::uint32_t;
struct uvec2 {
  uint x, y;
};
struct uvec4 {
  uint x, y, z, w;
};
struct vec4 {
  float x, y, z, w;
};
#endif

// What HLSL calls otherwise, of the structures that it has. It reaches nodes and counters as words.
#ifdef VITRAIL_HLSL
#define VITRAIL_FLOATS float4
#define VITRAIL_WORDS uint4
#else
#define VITRAIL_FLOATS vec4
#define VITRAIL_WORDS uvec4
#endif

// One stored fragment in each node format. They are vectors because a GPU stores one at once: collecting was seen to
// take as long as it has stores. A word that holds `next`, the index of the next node of the same pixel, has it in its
// low bits, 32 - coverage bits of them (24 in `compact`), and the coverage above it: no bits at 1 sample, 4 at 2 and 4
// samples, 8 at 8 samples.

// 12 bytes in two arrays: all of these first, then as many words with `next`.
//   x  8 bits each, r lowest: sRGB-encoded r, g, b and linear alpha
//   y  the bits of gl_FragCoord.z, in [0, 1], in the low 30 bits; the blend mode above them
#ifndef VITRAIL_HLSL
struct VitrailNodeStandard {
  uvec2 words;
};
#endif
// 8 bytes.
//   x  1 sample: r5 g6 b5 from bit 0 on the sRGB curve, depth code from bit 16.
//      Else: r5 g5 b5 from bit 0, the low 3 bits of alpha from bit 15, the depth code without its low 2 bits from
//      bit 18.
//   y  next; from bit 24: 1 sample: alpha in 6 bits. Else: coverage in 4 bits, the high 2 bits of alpha. From bit 30:
//      the blend mode.
#ifndef VITRAIL_HLSL
struct VitrailNodeCompact {
  uvec2 words;
};
#endif
// 16 bytes.
//   x  red and green, two 16-bit floats, red lowest
//   y  blue, a 16-bit float; alpha in 16 bits from bit 16
//   z  depth and blend mode as in VitrailNodeStandard
//   w  next
#ifndef VITRAIL_HLSL
struct VitrailNodeHdr {
  uvec4 words;
};
#endif
// A loose node, which is not on a list yet (VitrailListBuild), holds in place of `next` the number of its pixel in 24
// bits: VITRAIL_LOOSE_PIXELS of them at most. `standard` ones at 1 sample then also are as loose.glsl says.
//
// Where nodes carry a word of the host's, those words lie behind all that the format has of the pool's nodes: the word
// of node i is 32-bit word i from byte capacity * (bytes of a node) on.

// Counters of one thing, to be added up: work groups that add to one word at once wait for each other.
#define VITRAIL_COUNTERS 16

// The lists of one class of lengths, which a dispatch leaves to a later one: how many, and the work groups of that
// dispatch as vkCmdDispatchIndirect reads them.
struct VitrailListClass {
  uint count;
  uint groupsX;
  uint groupsY;
  uint groupsZ;
};
// Without networks there is one class, VITRAIL_CLASS_LONG, for all that are not short.
#define VITRAIL_CLASS_MEDIUM 0u
#define VITRAIL_CLASS_LONG 1u
#define VITRAIL_CLASS_LONGEST 2u
#define VITRAIL_LIST_CLASSES 3

// What a frame counts. All zero when the collect pass starts.
struct VitrailControl {
  uint requested;   // fragments that asked for a node: the index of the next one's, which may be beyond the pool
  uint wraps;       // VITRAIL_WRAP_STEP of them each are not in `requested`
  uint misfits;     // fragments whose shader cannot write to this target and that took no node: they are missing too
  uint misfitNodes; // nodes that such fragments were given, and left empty where they reach them
  uint layersMax;   // this and the next three are written by the resolve
  uint coveredPixels[VITRAIL_COUNTERS];
  uint cutPixels; // lists that the driver did not let it finish
  uint approximatePixels;
  uint collected;  // `requested` when the lists were built or found: fragments that came later are on none
  uint staleNodes; // 1: some of those nodes were not reached, and hold what they held before
  VitrailListClass classes[VITRAIL_LIST_CLASSES];
  // The arguments of indirect commands, which follow from the first four (src/kernels/arguments.glsl). Of a frame
  // without a fragment all are 0 but for `plain`.
  uint overflowGroupsX; // the dispatch that blends a frame that overflowed by its sums
  uint overflowGroupsY;
  uint overflowGroupsZ;
  uint pixelGroupsX; // dispatches over all pixels of the area
  uint pixelGroupsY;
  uint pixelGroupsZ;
  uint plainGroupsX; // the dispatch that averages the opaque samples of a frame without a fragment
  uint plainGroupsY;
  uint plainGroupsZ;
  uint drawVertices; // the draw of the fragment resolve, as vkCmdDrawIndirect reads it
  uint drawInstances;
  uint drawFirstVertex;
  uint drawFirstInstance;
  uint plainVertices; // its draw for a frame without a fragment
  uint plainInstances;
  uint plainFirstVertex;
  uint plainFirstInstance;
};

// Where languages that reach those as words find what a fragment counts, in bytes.
#define VITRAIL_CONTROL_REQUESTED 0
#define VITRAIL_CONTROL_WRAPS 4
#define VITRAIL_CONTROL_MISFITS 8
#define VITRAIL_CONTROL_MISFIT_NODES 12
#define VITRAIL_CONTROL_STALE_NODES 96

// How nodes are collected, as a number: a shader that was specialized for another target, that cannot reach the pool,
// or whose coverage has not passed the depth test that the target takes it to have passed, must not write to it.
// Samples are 1, 2, 4 or 8, the others behind them 0 or 1.
#define VITRAIL_LAYOUT(format, samples, keepSums, loose, userWords, byAddress, postDepth)                            \
  (((((((format)*4u + (samples) / 2u - (samples) / 8u) * 2u + (keepSums)) * 2u + (loose)) * 2u + (userWords)) * 2u + \
    (byAddress)) *                                                                                                   \
       2u +                                                                                                          \
   (postDepth))
#define VITRAIL_LAYOUTS 384

// What one vitrailVkCmdBegin sets (std140).
struct VitrailParameters {
  uint x; // the first pixel of the area
  uint y;
  uint width; // pixels of the area; the pitch of the head pointers
  uint height;
  uint capacity;     // nodes
  uint format;       // VITRAIL_FORMAT_*
  uint samples;      // 1, 2, 4, 8
  uint nearestIsOne; // 1: reversed depth
  uint keepSums;     // 1: fragments without a node are added to their pixel's sums
  uint loose;        // 1: a compute pass builds the lists
  uint nodesLow;     // the address of the pool, where it is reached by address
  uint nodesHigh;
  uint wholeByBinding; // 1: shaders reach the whole pool by its binding
  uint wholeByAddress; // 1: and those that define VITRAIL_BUFFER_REFERENCE, by its address
  uint userWords;      // 1: nodes carry a word of the host's
  uint frame;          // the low bits of its number, which its statistics are to have again
  // The nodes for shaders of each VITRAIL_LAYOUT: `capacity` for those that suit the target, else 0. Asking whether a
  // fragment's node is one of them asks both questions at once.
  VITRAIL_WORDS capacities[VITRAIL_LAYOUTS / 4];
};

// One fragment of a sorted list, as it was stored: what shaders that walk lists are given (list.glsl), and what copied
// lists hold.
struct VitrailLayer {
  VITRAIL_FLOATS color; // linear colour and alpha, as vitrailCollect() took them
  float depth;
  uint blend;    // VITRAIL_OVER, VITRAIL_PREMULTIPLIED, VITRAIL_ADDITIVE, VITRAIL_MULTIPLY
  uint coverage; // one bit a sample; 1 with one sample
  uint word;     // the host's; 0 where nodes carry none
};

// Copied lists: a buffer that holds, one behind the other,
//
//   VitrailCopyHeader   written by the library before the copy, with 0 layers
//   VitrailCopiedList   one a pixel of the rectangle, row by row
//   VitrailLayer        `capacity` of them. Those of a list lie together in order, nearest first; fragments that are
//                       alike in all else are in the order of their words. Lists follow each other in any order.
struct VitrailCopyHeader {
  uint layers;   // of all lists of the rectangle: more than `capacity` where some found no room
  uint capacity; // layers that the buffer has room for
  uint x;        // the rectangle, in pixels of the target; what of it lies outside of the frame's area has empty lists
  uint y;
  uint width;
  uint height;
  uint reserved[2];
};
struct VitrailCopiedList {
  // Its first layer. VITRAIL_END: it was left out, for want of room, because the frame overflowed, or because the
  // driver did not let it be sorted.
  uint first;
  uint count; // its layers
};

#ifdef __cplusplus
static_assert(sizeof(VitrailLayer) == 32);
static_assert(sizeof(VitrailCopyHeader) == 32);
static_assert(sizeof(VitrailCopiedList) == 8);
static_assert(sizeof(VitrailNodeStandard) == 8);
static_assert(sizeof(VitrailNodeCompact) == 8);
static_assert(sizeof(VitrailNodeHdr) == 16);
static_assert(sizeof(VitrailListClass) == 16);
static_assert(sizeof(VitrailControl) == 216);
static_assert(offsetof(VitrailControl, requested) == VITRAIL_CONTROL_REQUESTED); // collect.glsl has it as word 0, too,
static_assert(offsetof(VitrailControl, wraps) == VITRAIL_CONTROL_WRAPS);         // this as word 1
static_assert(offsetof(VitrailControl, misfits) == VITRAIL_CONTROL_MISFITS);     // and this as word 2
static_assert(offsetof(VitrailControl, misfitNodes) == VITRAIL_CONTROL_MISFIT_NODES);
static_assert(offsetof(VitrailControl, staleNodes) == VITRAIL_CONTROL_STALE_NODES);
static_assert(offsetof(VitrailControl, classes) == 100);
static_assert(offsetof(VitrailControl, overflowGroupsX) == 148);
static_assert(offsetof(VitrailControl, plainFirstInstance) == 212);
static_assert(offsetof(VitrailParameters, wholeByBinding) == 48);
static_assert(offsetof(VitrailParameters, capacities) == 64);
static_assert(sizeof(VitrailParameters) == 1600);
#define VITRAIL_CONSTANT constexpr uint
#elif defined(VITRAIL_HLSL)
#define VITRAIL_CONSTANT static const uint
#else
#define VITRAIL_CONSTANT const uint
#endif

VITRAIL_CONSTANT VITRAIL_END = 0xffffffffu; // a head pointer that has no list

// Counting goes on where the pool is full, and must not come round to nodes that are in use: the fragment that is given
// the index VITRAIL_WRAP_AT takes VITRAIL_WRAP_STEP from the count. No pool is larger than the rest of that, and never
// as many fragments as are left above it are under way at once.
VITRAIL_CONSTANT VITRAIL_WRAP_AT = 0xf0000000u;
VITRAIL_CONSTANT VITRAIL_WRAP_STEP = 0x10000000u;

// Node formats, with the values of VitrailNodeFormat.
VITRAIL_CONSTANT VITRAIL_FORMAT_STANDARD = 0u;
VITRAIL_CONSTANT VITRAIL_FORMAT_COMPACT = 1u;
VITRAIL_CONSTANT VITRAIL_FORMAT_HDR = 2u;

VITRAIL_CONSTANT VITRAIL_LOOSE_PIXELS = 0x1000000u; // of an area whose lists a compute pass builds

// Blend modes, with the values of VitrailBlend.
VITRAIL_CONSTANT VITRAIL_OVER = 0u;
VITRAIL_CONSTANT VITRAIL_PREMULTIPLIED = 1u;
VITRAIL_CONSTANT VITRAIL_ADDITIVE = 2u;
VITRAIL_CONSTANT VITRAIL_MULTIPLY = 3u;

VITRAIL_CONSTANT VITRAIL_SHORT_LIST = 16u;  // fragments that the first dispatch sorts
VITRAIL_CONSTANT VITRAIL_MEDIUM_LIST = 32u; // fragments that the second dispatch sorts
VITRAIL_CONSTANT VITRAIL_LONG_LIST = 64u;   // fragments that the third dispatch sorts, by networks

// Words of a pixel's sums: colour (3), opacity, -log2 of the transmittance.
VITRAIL_CONSTANT VITRAIL_SUM_WORDS = 5u;

#undef VITRAIL_CONSTANT
#undef VITRAIL_FLOATS
#undef VITRAIL_WORDS

#ifdef __cplusplus
} // namespace vitrail::layout
#endif

#endif
