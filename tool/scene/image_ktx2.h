// Reads KTX 2.0 textures (https://registry.khronos.org/KTX/specs/2.0/ktxspec.v2.html): the largest level of those that
// hold plain pixels of 8 or 16 bits a channel, as they are or packed with zlib or Zstandard. What is compressed for
// GPUs is refused, by name.
#pragma once

#include <cstddef>
#include <span>

#include "scene.h"

namespace vitrail::tool {

bool isKtx2(std::span<const std::byte> file);

// As decodeImage() does. Throws LoadError.
Image decodeKtx2(std::span<const std::byte> file);

} // namespace vitrail::tool
