// PNG files as pictures.
#pragma once

#include <cstddef>
#include <span>

#include "picture.h"

namespace vitrail::tool {

// The picture in a PNG file, whose values are taken as sRGB whatever colour space the file names; 16-bit channels are
// rounded to 8. It has alpha where any pixel is not opaque. Throws LoadError (scene/load.h) for what is no PNG or is
// damaged, and for a side above 16384 pixels.
Picture decodePng(std::span<const std::byte> file);

} // namespace vitrail::tool
