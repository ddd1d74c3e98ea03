// The `standard` node format on the CPU: what shaders/vitrail/node.glsl packs, written again for tests and references.
#pragma once

#include <array>
#include <cstdint>

#include "vitrail/layout.h"

namespace vitrail {

// Linear r, g, b and straight alpha.
using Color = std::array<double, 4>;

// The IEC 61966-2-1 (sRGB) curve and its inverse, for values in [0, 1].
double linearToSrgb(double linear);
double srgbToLinear(double srgb);

// Colour to the node's colour word and back. Packing clamps to [0, 1]; a NaN becomes 0.
std::uint32_t packColor(const Color& color);
Color unpackColor(std::uint32_t bits);

// gl_FragCoord.z to the node's depth word. Packing clamps to [0, 1]; a NaN becomes the farthest depth.
std::uint32_t packDepth(float depth, bool nearestIsOne);

// The depth word to a key that grows away from the viewer.
std::uint32_t depthKey(std::uint32_t depthBits, bool nearestIsOne);

} // namespace vitrail
