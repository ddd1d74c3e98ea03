// What encode.comp is dispatched with, whatever it writes to.
#pragma once

#include <cstdint>

namespace vitrail::tool {

struct EncodeBand { // the push constants
  std::uint32_t width;
  std::uint32_t height;
  std::uint32_t firstRow;
  std::uint32_t rows;
};

// Work groups along a side of so many pixels.
constexpr std::uint32_t encodeGroups(std::uint32_t pixels) {
  constexpr std::uint32_t kSide = 8;
  return (pixels + kSide - 1) / kSide;
}

} // namespace vitrail::tool
