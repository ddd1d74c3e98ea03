#include "png_decode.h"

#include <algorithm>
#include <array>
#include <utility>

#include "../scene/image_decode.h"
#include "../scene/load.h"

namespace vitrail::tool {

Picture decodePng(std::span<const std::byte> file) {
  constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  const bool isPng =
      file.size() >= kSignature.size() && std::equal(kSignature.begin(), kSignature.end(), file.begin(),
                                                     [](std::uint8_t a, std::byte b) { return std::byte{a} == b; });
  if (!isPng) throw LoadError("is not a PNG");
  Image image = decodeImage(file);
  Picture picture;
  picture.width = image.width;
  picture.height = image.height;
  picture.rgba = std::move(image.rgba);
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.hasAlpha |= picture.rgba[i] != 255;
  return picture;
}

} // namespace vitrail::tool
