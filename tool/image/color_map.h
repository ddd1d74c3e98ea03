// Numbers as colours.
#pragma once

#include <array>
#include <cstdint>

#include "picture.h"
#include "plane.h"

namespace vitrail::tool {

// Colours for the numbers 0 to 1, evenly apart, in sRGB; what lies between two is interpolated.
using ColorMap = std::array<std::array<std::uint8_t, 3>, 17>;

// Every 16th colour of matplotlib's maps magma and viridis (Nathaniel Smith and Stéfan van der Walt, 2015, CC0), which
// rise evenly in lightness, so that they read the same to colour-blind eyes and in grey.
extern const ColorMap kMagma;
extern const ColorMap kViridis;

// Each value over `largest`, clamped to 0 and 1, as a colour.
Picture heatmap(const Plane& plane, double largest, const ColorMap& map);

} // namespace vitrail::tool
