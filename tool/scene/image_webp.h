// Decodes WebP images with libwebp.
#pragma once

#include <cstddef>
#include <span>

#include "scene.h"

namespace vitrail::tool {

bool isWebp(std::span<const std::byte> file);

// As decodeImage() does. Throws LoadError.
Image decodeWebp(std::span<const std::byte> file);

} // namespace vitrail::tool
