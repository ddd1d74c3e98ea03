// What a resolve must compute, in double precision: sort one pixel's fragments and blend them over what is behind.
#pragma once

#include <cstdint>
#include <span>

#include "node.h"

namespace vitrail {

// One stored fragment without its link.
struct StoredFragment {
  std::uint32_t color = 0; // node.h's colour word
  std::uint32_t depth = 0; // node.h's depth word
};

// Blends `fragments`, in any order, over `behind` (linear, premultiplied alpha) with the over operator (Porter and Duff
// 1984). Equal depths are ordered by their colour words, the smaller one nearer, as on the GPU.
Color resolveReference(std::span<const StoredFragment> fragments, const Color& behind, bool nearestIsOne);

} // namespace vitrail
