// What a frame must look like: every pixel by brute force, over all primitives, with integer edge functions, a sort and
// sums in double precision.
#pragma once

#include <vector>

#include "library/reference/resolve.h"
#include "scene.h"

namespace vitrail::tests::raster {

struct Expected {
  std::vector<Color> pixels;
  std::vector<double> depth; // samples a pixel
  // Pixels in which two depths are so close that rounding decides which is in front.
  std::vector<bool> isUndecided;
  std::vector<double> noise;         // what roundings of the weights may add up to
  std::vector<std::uint32_t> layers; // transparent fragments in front of opaque surfaces
};

Expected expectedOf(const Scene& scene);

} // namespace vitrail::tests::raster
