// The last step of a picture that the processor draws: linear light to the numbers of a file, by the rules of
// render/encode.comp.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picture.h"

namespace vitrail::tool {

// Encodes `count` pixels of linear, premultiplied r, g, b, alpha, as Encoding::Srgb8 and as one of the others. A NaN
// counts as 0. The 8-bit code of a colour is the right one for every float; 16-bit codes are off by less than 1/100 of
// a step before they are rounded.
void encodePixels(const float* linear, std::size_t count, std::uint8_t* rgba);
void encodePixels(const float* linear, std::size_t count, Encoding encoding, std::uint16_t* rgba);

} // namespace vitrail::tool
