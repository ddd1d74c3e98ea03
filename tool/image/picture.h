// A finished picture: 8-bit RGBA, sRGB curve, straight alpha, rows top to bottom without padding.
#pragma once

#include <cstdint>
#include <vector>

namespace vitrail::tool {

struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool hasAlpha = false;          // false: every alpha is 255, and a file need not store it
  std::vector<std::uint8_t> rgba; // width * height * 4
};

} // namespace vitrail::tool
