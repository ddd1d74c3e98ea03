// Finished pictures, rows top to bottom without padding.
#pragma once

#include <cstdint>
#include <vector>

namespace vitrail::tool {

// What the numbers of a pixel are.
enum class Encoding {
  Srgb8,  // 8-bit RGBA, sRGB curve, straight alpha
  Srgb16, // the same with 16 bits
  Linear  // halves (IEEE 754 binary16): linear light, Rec. 709 primaries, premultiplied alpha
};

// Encoding::Srgb8.
struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool hasAlpha = false;          // false: every alpha is 255, and a file need not store it
  std::vector<std::uint8_t> rgba; // width * height * 4
};

// One of the other encodings.
struct DeepPicture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool hasAlpha = false; // false: every alpha is 1
  Encoding encoding = Encoding::Srgb16;
  std::vector<std::uint16_t> rgba; // width * height * 4
};

} // namespace vitrail::tool
