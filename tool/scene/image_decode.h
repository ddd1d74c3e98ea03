// Decodes the image files that models use: PNG, JPEG, WebP, KTX2, GIF, BMP and TGA, told apart by their content.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "scene.h"

namespace vitrail::tool {

// The image as 8-bit RGBA; 16-bit channels are rounded to 8, missing alpha is 255, grey becomes three channels. Throws
// LoadError for what is no image, is damaged, has a side above 16384 pixels, or is far larger than its file can hold.
Image decodeImage(std::span<const std::byte> file);

bool isPng(std::span<const std::byte> file);

// For the decoders of single formats.

bool startsWith(std::span<const std::byte> file, std::string_view signature);

// Throws LoadError where a side is not from 1 to 16384, or where a file of that size cannot hold so many pixels: no
// more than `pixelsPerByte`. So many as `alwaysAllowed` may take next to nothing.
void checkImageSize(std::int64_t width, std::int64_t height, std::size_t fileSize, std::uint64_t pixelsPerByte,
                    std::uint64_t alwaysAllowed);
constexpr std::uint64_t plainImagePixels = std::uint64_t{1} << 24U; // of formats that pack one colour into no bits

} // namespace vitrail::tool
