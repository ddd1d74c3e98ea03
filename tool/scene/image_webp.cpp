#include "image_webp.h"

#include <cstdint>

#include <webp/decode.h>

#include "image_decode.h"
#include "load.h"

namespace vitrail::tool {

bool isWebp(std::span<const std::byte> file) {
  return file.size() >= 12 && startsWith(file, "RIFF") && startsWith(file.subspan(8), "WEBP");
}

Image decodeWebp(std::span<const std::byte> file) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(file.data());
  WebPBitstreamFeatures features{};
  if (WebPGetFeatures(bytes, file.size(), &features) != VP8_STATUS_OK)
    throw LoadError("the image cannot be decoded: it is no sound WebP");
  if (features.has_animation != 0) throw LoadError("the image is an animation, of which no frame is read");
  // An image of one colour takes no bits a pixel; others more than this.
  checkImageSize(features.width, features.height, file.size(), 1024, plainImagePixels);
  Image image{static_cast<std::uint32_t>(features.width), static_cast<std::uint32_t>(features.height), {}};
  image.rgba.resize(std::size_t{4} * image.width * image.height);
  if (WebPDecodeRGBAInto(bytes, file.size(), image.rgba.data(), image.rgba.size(), 4 * features.width) == nullptr)
    throw LoadError("the image cannot be decoded: its WebP data are damaged or cut off");
  return image;
}

} // namespace vitrail::tool
