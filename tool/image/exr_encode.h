// Pictures as OpenEXR files in memory.
#pragma once

#include <cstddef>
#include <vector>

#include "picture.h"

namespace vitrail::tool {

enum class ExrNumbers { Half, Float };

// Encodes a picture of Encoding::Linear: channels R, G, B, and A where the picture has alpha, by which the colours are
// multiplied; Rec. 709 primaries; ZIP compression. The same picture gives the same bytes. Throws std::runtime_error
// with OpenEXR's reason.
std::vector<std::byte> encodeExr(const DeepPicture& picture, ExrNumbers numbers);

} // namespace vitrail::tool
