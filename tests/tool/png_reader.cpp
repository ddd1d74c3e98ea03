#include "png_reader.h"

#include <png.h>

#include <stdexcept>

namespace vitrail::tests {

ReadPng readPng(const std::filesystem::path& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) throw std::runtime_error(image.message);
  ReadPng result;
  result.width = image.width;
  result.height = image.height;
  result.hasAlpha = (image.format & PNG_FORMAT_FLAG_ALPHA) != 0;
  image.format = PNG_FORMAT_RGBA;
  result.rgba.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, result.rgba.data(), 0, nullptr) == 0) {
    throw std::runtime_error(image.message);
  }
  return result;
}

} // namespace vitrail::tests
