#include "png_decode.h"

#include <utility>

#include "../scene/image_decode.h"
#include "../scene/load.h"

namespace vitrail::tool {

Picture decodePng(std::span<const std::byte> file) {
  if (!isPng(file)) throw LoadError("is not a PNG");
  Image image = decodeImage(file);
  Picture picture;
  picture.width = image.width;
  picture.height = image.height;
  picture.rgba = std::move(image.rgba);
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.hasAlpha |= picture.rgba[i] != 255;
  return picture;
}

} // namespace vitrail::tool
