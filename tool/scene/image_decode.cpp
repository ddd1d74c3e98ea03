// Decodes image files: those that no other file here is for with stb_image, after checking what it would allocate.
#include "image_decode.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "image_ktx2.h"
#include "image_webp.h"
#include "load.h"

// A JPEG may name a Huffman table that it never defines. In zeroed memory such a table decodes to nothing; in any other
// stb_image would read past its end.
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(pointer, size) std::realloc(pointer, size)
#define STBI_FREE(pointer) std::free(pointer)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_FAILURE_USERMSG
#define STBI_NO_STDIO
#define STBI_ONLY_BMP
#define STBI_ONLY_GIF
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_ONLY_TGA
#ifdef __clang__
// Two things that stb_image does to broken files are harmless, but the sanitizer cannot know: where a JPEG runs out of
// bits it shifts a zero by more than its width before it refuses the file, and of an empty PNG chunk it copies no bytes
// to a null pointer.
#pragma clang attribute push(__attribute__((no_sanitize("shift", "nonnull-attribute"))), apply_to = function)
#endif
#include <stb/stb_image.h>
#ifdef __clang__
#pragma clang attribute pop
#endif

namespace vitrail::tool {
namespace {

constexpr std::int64_t longestSide = 16384;
constexpr std::string_view pngSignature = "\x89PNG\r\n\x1a\n";
constexpr std::string_view jpegSignature = "\xff\xd8\xff";
constexpr std::string_view gifSignature = "GIF8";
constexpr std::string_view bmpSignature = "BM";

// A header can state any size; the decoder would allocate it before it misses the data. No compression that it reads
// packs more than this: PNG's deflate reaches 1032 bytes for one, and a byte holds up to 8 pixels; in JPEG a block of
// 64 pixels takes a bit at least; in GIF a code of 12 bits stands for at most 4096 pixels.
std::uint64_t mostPixelsPerByte(std::span<const std::byte> file) {
  if (isPng(file)) return 1032 * 8;
  return startsWith(file, gifSignature) ? 4096 : 1024;
}

// PNG files state their bit depth, which narrows the bound.
bool plausiblePng(std::span<const std::byte> file, std::uint64_t pixels) {
  constexpr std::size_t bitDepthOffset = 24;
  constexpr std::size_t colorTypeOffset = 25;
  if (file.size() <= colorTypeOffset) return false;
  const auto depth = std::to_integer<std::uint64_t>(file[bitDepthOffset]);
  const auto colorType = std::to_integer<unsigned>(file[colorTypeOffset]);
  const std::uint64_t channels = colorType == 2 ? 3 : colorType == 4 ? 2 : colorType == 6 ? 4 : 1;
  return pixels * depth * channels / 8 / 1032 <= file.size();
}

// Whether all chunks of a PNG lie within the file: the decoder takes memory for one as long as it says that it is.
bool pngChunksFit(std::span<const std::byte> file) {
  constexpr std::size_t front = 8; // length and kind; a checksum of 4 bytes ends a chunk
  constexpr std::size_t frame = 12;
  for (std::size_t i = pngSignature.size(); file.size() - i >= front;) {
    if (startsWith(file.subspan(i + 4), "IEND")) return true;
    std::size_t length = 0;
    for (std::size_t byte = 0; byte < 4; ++byte) length = length << 8U | std::to_integer<std::size_t>(file[i + byte]);
    if (file.size() - i < frame || length > file.size() - i - frame) return false;
    i += frame + length;
  }
  return true;
}

LoadError tooLarge(std::int64_t width, std::int64_t height, std::size_t fileSize) {
  return LoadError(
      fmt::format("the image states {} x {} pixels, but its file has only {} bytes", width, height, fileSize));
}

// Whether all Huffman tables of a JPEG fit their 256 symbols. Some versions of stb_image write past the end of a table
// that states more. Looks at every marker that the decoder can come to: in compressed data an 0xff that begins none is
// followed by zero or a restart marker.
bool hasSoundHuffmanTables(std::span<const std::byte> file) {
  const auto at = [file](std::size_t offset) {
    return offset < file.size() ? std::to_integer<std::size_t>(file[offset]) : 0;
  };
  constexpr std::size_t defineTables = 0xc4;
  for (std::size_t i = 0; i + 1 < file.size();) {
    const std::size_t marker = at(i + 1);
    const bool segment = at(i) == 0xff && marker >= 0xc0 && marker != 0xff && (marker < 0xd0 || marker > 0xd9);
    if (!segment) {
      ++i;
      continue;
    }
    const std::size_t length = at(i + 2) * 256 + at(i + 3);
    if (marker == defineTables) {
      // Each table has a byte of number and class, 16 counts of codes by length, and as many symbols.
      for (std::size_t table = i + 4; table < i + 2 + length && table < file.size();) {
        std::size_t symbols = 0;
        for (std::size_t count = 1; count <= 16; ++count) symbols += at(table + count);
        if (symbols > 256) return false;
        table += 17 + symbols;
      }
    }
    i += 2 + length;
  }
  return true;
}

struct FreePixels {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

std::uint8_t roundedTo8Bits(std::uint16_t value) {
  return static_cast<std::uint8_t>((static_cast<std::uint32_t>(value) * 255U + 32767U) / 65535U);
}

// What is known by its first bytes, but not read.
std::string_view unreadKind(std::span<const std::byte> file) {
  if (file.size() >= 12 && startsWith(file.subspan(4), "ftyp")) {
    if (startsWith(file.subspan(8), "avi")) return "AVIF";
    if (startsWith(file.subspan(8), "he") || startsWith(file.subspan(8), "mif1")) return "HEIF";
  }
  if (startsWith(file, "DDS ")) return "DDS";
  if (startsWith(file, "\xabKTX 11\xbb")) return "KTX 1";
  if (startsWith(file, "sB")) return "Basis Universal";
  if (startsWith(file, {"II*\0", 4}) || startsWith(file, {"MM\0*", 4})) return "TIFF";
  if (startsWith(file, "\x76\x2f\x31\x01")) return "OpenEXR";
  if (startsWith(file, "#?")) return "Radiance HDR";
  if (startsWith(file, "<svg") || startsWith(file, "<?xml")) return "SVG";
  return {};
}

Image decodeWithStb(std::span<const std::byte> file) {
  if (file.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw LoadError("the image file is larger than 2 GiB");
  if (isPng(file) && !pngChunksFit(file)) throw LoadError("the image cannot be decoded: the PNG is cut off");
  // stb_image passes over any number of these bytes before a JPEG.
  if (startsWith(file, "\xff") && !hasSoundHuffmanTables(file))
    throw LoadError("the image cannot be decoded: a Huffman table of the JPEG has too many symbols");
  const auto* bytes = reinterpret_cast<const stbi_uc*>(file.data());
  const int size = static_cast<int>(file.size());
  int width = 0;
  int height = 0;
  int channels = 0;
  const auto fail = [] { throw LoadError(fmt::format("the image cannot be decoded: {}", stbi_failure_reason())); };
  const bool known = isPng(file) || startsWith(file, jpegSignature) || startsWith(file, gifSignature) ||
                     startsWith(file, bmpSignature);
  if (stbi_info_from_memory(bytes, size, &width, &height, &channels) == 0) {
    if (!known) throw LoadError("is no image that can be read: none of PNG, JPEG, WebP, KTX2, GIF, BMP and TGA");
    fail();
  }
  checkImageSize(width, height, file.size(), mostPixelsPerByte(file), 0);
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (isPng(file) && !plausiblePng(file, pixels)) throw tooLarge(width, height, file.size());

  Image image{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  const std::size_t valueCount = static_cast<std::size_t>(pixels) * 4;
  if (stbi_is_16_bit_from_memory(bytes, size) != 0) {
    const std::unique_ptr<stbi_us, FreePixels> data(
        stbi_load_16_from_memory(bytes, size, &width, &height, &channels, 4));
    if (!data) fail();
    image.rgba.resize(valueCount);
    std::transform(data.get(), data.get() + valueCount, image.rgba.begin(), roundedTo8Bits);
  } else {
    const std::unique_ptr<stbi_uc, FreePixels> data(stbi_load_from_memory(bytes, size, &width, &height, &channels, 4));
    if (!data) fail();
    image.rgba.assign(data.get(), data.get() + valueCount);
  }
  return image;
}

} // namespace

bool startsWith(std::span<const std::byte> file, std::string_view signature) {
  return file.size() >= signature.size() &&
         std::equal(signature.begin(), signature.end(), file.begin(),
                    [](char a, std::byte b) { return static_cast<std::byte>(a) == b; });
}

void checkImageSize(std::int64_t width, std::int64_t height, std::size_t fileSize, std::uint64_t pixelsPerByte,
                    std::uint64_t alwaysAllowed) {
  if (width < 1 || height < 1 || width > longestSide || height > longestSide)
    throw LoadError(
        fmt::format("the image has {} x {} pixels, but a side may have 1 to {}", width, height, longestSide));
  const auto pixels = static_cast<std::uint64_t>(width * height);
  if (pixels > alwaysAllowed && pixels / pixelsPerByte > fileSize) throw tooLarge(width, height, fileSize);
}

bool isPng(std::span<const std::byte> file) { return startsWith(file, pngSignature); }

Image decodeImage(std::span<const std::byte> file) {
  if (isWebp(file)) return decodeWebp(file);
  if (isKtx2(file)) return decodeKtx2(file);
  const std::string_view kind = unreadKind(file);
  if (!kind.empty()) throw LoadError(fmt::format("is an image of the kind {}, which is not read", kind));
  return decodeWithStb(file);
}

} // namespace vitrail::tool
