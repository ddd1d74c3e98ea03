#include "png_encode.h"

#include <png.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace vitrail::tool {

namespace {

void append(png_structp png, png_bytep data, std::size_t size) {
  auto& bytes = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* first = reinterpret_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), first, first + size);
}

[[noreturn]] void fail(png_structp /*png*/, png_const_charp reason) {
  throw std::runtime_error(std::string("the PNG could not be encoded: ") + reason);
}

void ignore(png_structp /*png*/, png_const_charp /*warning*/) {}

// Frees libpng's state on every way out.
struct Writer {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  Writer() = default;
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
};

} // namespace

std::vector<std::byte> encodePng(const Picture& picture) {
  Writer writer;
  if (writer.info == nullptr) throw std::runtime_error("the PNG could not be encoded: no memory for libpng");
  png_structp png = writer.png;

  std::vector<std::byte> bytes;
  png_set_write_fn(png, &bytes, append, nullptr);
  png_set_user_limits(png, picture.width, picture.height);
  png_set_IHDR(png, writer.info, picture.width, picture.height, 8,
               picture.hasAlpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  // Nearly as small as the default level 6 on rendered pictures, in a third of the time.
  png_set_compression_level(png, 4);
  png_write_info(png, writer.info);
  if (!picture.hasAlpha) png_set_filler(png, 0, PNG_FILLER_AFTER); // drops the fourth byte of each pixel
  const std::size_t pitch = std::size_t{picture.width} * 4;
  for (std::uint32_t y = 0; y < picture.height; ++y) png_write_row(png, picture.rgba.data() + y * pitch);
  png_write_end(png, writer.info);
  return bytes;
}

} // namespace vitrail::tool
