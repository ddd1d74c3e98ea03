// The structures that shaders and C++ share. This file is both GLSL and C++: it stands once, C++ asserts the sizes
// below, and a test reads the strides and offsets of the compiled SPIR-V.
#ifndef VITRAIL_LAYOUT_H
#define VITRAIL_LAYOUT_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
namespace vitrail::layout {
using uint = std::uint32_t;
#endif

// One stored fragment of the `standard` node format.
struct VitrailNode {
  uint color; // 8 bits each, r lowest: sRGB-encoded r, g, b and linear alpha
  uint depth; // the bits of gl_FragCoord.z, in [0, 1]
  uint next;  // index of the next node of the same pixel, or VITRAIL_END
};

// What a frame counts. All zero when the collect pass starts.
struct VitrailControl {
  uint stored;     // nodes taken; above the capacity only while fragments that got none are giving them back
  uint missingLow; // fragments that found the pool full, 64 bits in two words
  uint missingHigh;
  uint layersMax;     // written by the resolve
  uint coveredPixels; // written by the resolve
  uint cutPixels;     // written by the resolve: lists that the driver did not let it finish
  uint longLists;     // written by the resolve: lists that are left to its second dispatch
  uint groupsX;       // the work groups of that dispatch, as vkCmdDispatchIndirect reads them
  uint groupsY;
  uint groupsZ;
};

// What does not change during the life of a target.
struct VitrailParameters {
  uint width; // pixels; the pitch of the head pointers
  uint height;
  uint capacity;     // nodes
  uint nearestIsOne; // 1: reversed depth
};

#ifdef __cplusplus
static_assert(sizeof(VitrailNode) == 12);
static_assert(sizeof(VitrailControl) == 40);
static_assert(sizeof(VitrailParameters) == 16);
constexpr uint VITRAIL_END = 0xffffffffu; // the index that ends a list
constexpr uint VITRAIL_BLOCK = 16u;       // fragments that are sorted in registers
} // namespace vitrail::layout
#else
const uint VITRAIL_END = 0xffffffffu;
const uint VITRAIL_BLOCK = 16u;
#endif

#endif
