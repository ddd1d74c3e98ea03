// One channel of a picture as numbers, and the filters that image metrics run over it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vitrail::tool {

struct Plane {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<double> values; // width * height, rows top to bottom

  Plane() = default;
  Plane(std::uint32_t planeWidth, std::uint32_t planeHeight)
      : width(planeWidth), height(planeHeight), values(std::size_t{planeWidth} * planeHeight) {}
};

// Correlates each row with `alongRows` and each column with `alongColumns`, both of odd length and centred on the
// pixel. The pixels of the border go on outside.
Plane filter(const Plane& source, std::span<const double> alongRows, std::span<const double> alongColumns);

} // namespace vitrail::tool
