// How far a picture is from the reference, away from triangle edges and on them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>

#include "../../tool/image/picture.h"
#include "reference.h"

namespace vitrail::tool::reference {

struct Comparison {
  int away = 0;            // the largest difference of a channel, in 1/255, over all pixels that are not edge pixels
  std::uint32_t awayX = 0; // the pixel where that is
  std::uint32_t awayY = 0;
  double edgeShare = 0.0; // edge pixels, as a share of all pixels
  double edgeOver = 0.0;  // edge pixels that differ by more than the bound, as a share of all pixels
  std::size_t beyond = 0; // other pixels that differ by more than the bound
};

// Compares a rendered picture with one of the two of a reference. `bound` is a channel difference in 1/255. Throws
// std::invalid_argument where the pictures differ in size or in having alpha.
Comparison compare(const Picture& rendered, const ReferencePicture& expected, const Reference& reference, int bound);

std::ostream& operator<<(std::ostream& out, const Comparison& comparison);

// Bounds on what a frame may count, from the reference's layer ranges.
struct LayerBounds {
  std::uint64_t fragmentsLeast = 0;
  std::uint64_t fragmentsMost = 0;
  std::uint32_t deepestLeast = 0;
  std::uint32_t deepestMost = 0;
};

LayerBounds layerBounds(const Reference& reference);

} // namespace vitrail::tool::reference
