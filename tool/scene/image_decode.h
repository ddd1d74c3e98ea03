// Decodes the image files that models use: PNG, JPEG, and for OBJ materials BMP and TGA.
#pragma once

#include <cstddef>
#include <span>

#include "scene.h"

namespace vitrail::tool {

bool isPng(std::span<const std::byte> file);

// True for the two formats that glTF allows.
bool isPngOrJpeg(std::span<const std::byte> file);

// The image as 8-bit RGBA; 16-bit channels are rounded to 8, missing alpha is 255, grey becomes three channels. Throws
// LoadError for what is no image, is damaged, has a side above 16384 pixels, or is far larger than its file can hold.
Image decodeImage(std::span<const std::byte> file);

} // namespace vitrail::tool
