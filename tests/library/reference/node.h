// The node formats on the CPU, in double precision: what shaders/vitrail/node.glsl packs, written again from layout.h
// and vitrail.h for tests and references.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "vitrail/layout.h"

namespace vitrail {

// Linear r, g, b and alpha.
using Color = std::array<double, 4>;

// The IEC 61966-2-1 (sRGB) curve and its inverse, for values in [0, 1].
double linearToSrgb(double linear);
double srgbToLinear(double srgb);

// A value in [0, 65504] to the nearest 16-bit float, ties to even, and back.
std::uint32_t toHalf(double value);
double fromHalf(std::uint32_t bits);

// How the nodes of a target are stored.
struct NodeCoding {
  std::uint32_t format = layout::VITRAIL_FORMAT_STANDARD;
  std::uint32_t samples = 1; // 1, 2, 4, 8
  bool nearestIsOne = false;
  // VITRAIL_LIST_BUILD_COMPUTE: on their way into `standard` nodes at 1 sample colours are rounded once more
  // (shaders/vitrail/loose.glsl).
  bool builtByCompute = false;
};

// What a shader hands to vitrailCollect(), or what is left of it once it is stored.
struct Fragment {
  Color color{};
  float depth = 0.0F; // gl_FragCoord.z
  std::uint32_t blend = layout::VITRAIL_OVER;
  std::uint32_t coverage = 1; // a bit a sample
};

// The words of a node in the order of its struct. A word that holds `next` holds 0 there; words beyond the struct are
// 0.
using NodeWords = std::array<std::uint32_t, 4>;

// Stores a fragment; nothing where that would change nothing and is dropped: a stored alpha of 0 (premultiplied: and a
// stored colour of 0), or no coverage. Colours and depths of any value, NaNs included, are taken.
std::optional<NodeWords> packNode(const NodeCoding& coding, const Fragment& fragment);

// The stored values. `depth` of the compact format is that of the code, in single precision.
Fragment unpackNode(const NodeCoding& coding, const NodeWords& words);

// A place in the order of a list: smaller keys are nearer. A key is the whole node without its `next`, so that nodes
// with equal keys are equal. Compared word by word:
//   standard  depth key << 2 | blend, colour, coverage
//   hdr       depth key << 2 | blend, redGreen, blueAlpha, coverage
//   compact   depth key, then from high to low in one word: blend, alpha, coverage, rgb, each in as many bits as stored
using SortKey = std::array<std::uint32_t, 4>;
SortKey sortKey(const NodeCoding& coding, const NodeWords& words);

// gl_FragCoord.z as a key that grows away from the viewer: what a node of that depth begins its SortKey with, without
// the blend mode.
std::uint32_t depthKey(const NodeCoding& coding, float depth);

} // namespace vitrail
