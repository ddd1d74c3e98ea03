// What a resolve counted over the whole picture.
#pragma once

#include <algorithm>
#include <cstdint>

#include "counts_shared.h"

namespace vitrail::tool {

struct PictureCounts {
  std::uint64_t coveredPixels = 0;
  std::uint32_t layersMax = 0;
  std::uint32_t cutPixels = 0;
  std::uint64_t fragments = 0;
};

inline PictureCounts pictureCounts(const shaders::GroupCounts (&groups)[shaders::COUNT_SLOTS]) {
  PictureCounts sum;
  for (const shaders::GroupCounts& group : groups) {
    sum.coveredPixels += group.coveredPixels;
    sum.layersMax = std::max(sum.layersMax, group.layersMax);
    sum.cutPixels += group.cutPixels;
    sum.fragments += group.fragments;
  }
  return sum;
}

} // namespace vitrail::tool
