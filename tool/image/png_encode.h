// Pictures as PNG files in memory.
#pragma once

#include <cstddef>
#include <vector>

#include "picture.h"

namespace vitrail::tool {

// Encodes an 8-bit sRGB PNG: RGB, or RGBA with straight alpha where the picture has alpha. The same picture gives the
// same bytes.
std::vector<std::byte> encodePng(const Picture& picture);

// The same with 16 bits: of Encoding::Srgb16.
std::vector<std::byte> encodePng(const DeepPicture& picture);

} // namespace vitrail::tool
