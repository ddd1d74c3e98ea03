#include "image_ktx2.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include "bytes.h"
#include "image_decode.h"
#include "load.h"

namespace vitrail::tool {
namespace {

constexpr std::string_view signature = "\xabKTX 20\xbb\r\n\x1a\n";

enum class Scheme : std::uint32_t { None = 0, BasisLz = 1, Zstd = 2, Zlib = 3 };

// A plain format of Vulkan.
struct Format {
  std::uint32_t unorm; // its number
  std::uint32_t srgb;  // that of its sRGB twin; the same where it has none
  std::size_t channels;
  std::size_t bytes; // a channel
  bool blueFirst = false;
};

constexpr std::array<Format, 10> formats{{{9, 15, 1, 1},
                                          {16, 22, 2, 1},
                                          {23, 29, 3, 1},
                                          {30, 36, 3, 1, true},
                                          {37, 43, 4, 1},
                                          {44, 50, 4, 1, true},
                                          {70, 70, 1, 2},
                                          {77, 77, 2, 2},
                                          {84, 84, 3, 2},
                                          {91, 91, 4, 2}}};

struct Header {
  std::uint32_t format;
  std::uint32_t width;
  std::uint32_t height;
  std::uint32_t scheme;
  std::uint32_t colorModel; // of the data format descriptor
  std::array<char, 4> swizzle{'r', 'g', 'b', 'a'};
  bool upwards = false; // the first row is the lowest
};

std::uint64_t littleEndian64(std::span<const std::byte> bytes, std::size_t offset) {
  return littleEndian(bytes, offset) | std::uint64_t{littleEndian(bytes, offset + 4)} << 32U;
}

// A part of the file whose place another part states.
std::span<const std::byte> partOf(std::span<const std::byte> file, std::uint64_t offset, std::uint64_t size) {
  if (offset > file.size() || size > file.size() - offset)
    throw LoadError(fmt::format("the KTX2 file is cut off: {} bytes at offset {} are stated, but it has {}", size,
                                offset, file.size()));
  return file.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
}

// What the file says in words that matters here; anything else, and what is damaged, is passed over.
void readKeyValues(std::span<const std::byte> data, Header& header) {
  while (data.size() >= 4) {
    const std::size_t length = littleEndian(data, 0);
    if (length > data.size() - 4) return;
    const std::string_view pair(reinterpret_cast<const char*>(data.data()) + 4, length);
    const std::size_t end = pair.find('\0');
    const std::string_view key = pair.substr(0, end);
    const std::string_view value = end == std::string_view::npos ? std::string_view{} : pair.substr(end + 1);
    if (key == "KTXswizzle" && value.size() >= 4 && value.substr(0, 4).find_first_not_of("rgba01") == value.npos)
      std::copy_n(value.begin(), 4, header.swizzle.begin());
    if (key == "KTXorientation" && value.size() >= 2) header.upwards = value[1] == 'u';
    data = data.subspan(std::min(data.size(), 4 + (length + 3) / 4 * 4));
  }
}

Header readHeader(std::span<const std::byte> file) {
  constexpr std::size_t size = 80;
  if (file.size() < size) throw LoadError("the KTX2 file ends in its header");
  Header header{littleEndian(file, 12), littleEndian(file, 20), littleEndian(file, 24), littleEndian(file, 44), 0};
  const std::span<const std::byte> descriptor = partOf(file, littleEndian(file, 48), littleEndian(file, 52));
  if (descriptor.size() > 12) header.colorModel = std::to_integer<std::uint32_t>(descriptor[12]);
  readKeyValues(partOf(file, littleEndian(file, 56), littleEndian(file, 60)), header);
  return header;
}

const Format& formatOf(const Header& header) {
  constexpr std::uint32_t etc1s = 163;
  constexpr std::uint32_t uastc = 166;
  if (header.scheme == static_cast<std::uint32_t>(Scheme::BasisLz) || header.colorModel == etc1s ||
      header.colorModel == uastc)
    throw LoadError(fmt::format("is Basis Universal ({}), which no library of Debian decodes",
                                header.colorModel == uastc ? "UASTC" : "ETC1S"));
  const auto format = std::ranges::find_if(
      formats, [&](const Format& f) { return f.unorm == header.format || f.srgb == header.format; });
  if (format == formats.end())
    throw LoadError(fmt::format("is KTX2 of the Vulkan format {}; only plain pixels of 8 or 16 bits a channel are read",
                                header.format));
  return *format;
}

std::vector<std::byte> unpacked(std::span<const std::byte> data, std::uint32_t scheme, std::size_t size) {
  if (scheme == static_cast<std::uint32_t>(Scheme::None)) return {data.begin(), data.end()};
  std::vector<std::byte> bytes(size);
  if (scheme == static_cast<std::uint32_t>(Scheme::Zstd)) {
    const std::size_t result = ZSTD_decompress(bytes.data(), bytes.size(), data.data(), data.size());
    if (ZSTD_isError(result) != 0) throw LoadError("the KTX2 file's Zstandard data are damaged");
    bytes.resize(result);
  } else if (scheme == static_cast<std::uint32_t>(Scheme::Zlib)) {
    uLongf length = static_cast<uLongf>(bytes.size());
    if (uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length, reinterpret_cast<const Bytef*>(data.data()),
                   static_cast<uLong>(data.size())) != Z_OK)
      throw LoadError("the KTX2 file's zlib data are damaged");
    bytes.resize(length);
  } else {
    throw LoadError(fmt::format("the KTX2 file is packed with scheme {}, which is unknown", scheme));
  }
  return bytes;
}

// One channel of one pixel as 8 bits; `letter` is one of the swizzle's.
std::uint8_t channel(const std::byte* pixel, const Format& format, char letter) {
  if (letter == '0' || letter == '1') return letter == '1' ? 255 : 0;
  std::size_t index = letter == 'r' ? 0 : letter == 'g' ? 1 : letter == 'b' ? 2 : 3;
  if (index >= format.channels) return index == 3 ? 255 : 0;
  if (format.blueFirst && index < 3) index = 2 - index;
  if (format.bytes == 1) return std::to_integer<std::uint8_t>(pixel[index]);
  const auto value =
      std::to_integer<std::uint32_t>(pixel[2 * index]) | std::to_integer<std::uint32_t>(pixel[2 * index + 1]) << 8U;
  return static_cast<std::uint8_t>((value * 255U + 32767U) / 65535U);
}

} // namespace

bool isKtx2(std::span<const std::byte> file) { return startsWith(file, signature); }

Image decodeKtx2(std::span<const std::byte> file) {
  const Header header = readHeader(file);
  const Format& format = formatOf(header);
  const std::uint32_t height = std::max(header.height, 1U);
  // Zstandard packs a block of 128 KiB into few bytes.
  checkImageSize(header.width, height, file.size(), 32768, plainImagePixels);
  constexpr std::size_t firstLevel = 80;
  if (file.size() < firstLevel + 24) throw LoadError("the KTX2 file ends in its header");
  const std::size_t pixelBytes = format.channels * format.bytes;
  const std::size_t size = pixelBytes * header.width * height;
  const std::uint64_t stated = littleEndian64(file, firstLevel + 16); // with all layers and faces of the level
  // The first picture is wanted, but both packings are undone whole.
  constexpr std::uint64_t mostLayers = 16;
  if (stated > mostLayers * size + 1024) throw LoadError("the KTX2 file holds too many layers");
  const std::vector<std::byte> pixels =
      unpacked(partOf(file, littleEndian64(file, firstLevel), littleEndian64(file, firstLevel + 8)), header.scheme,
               std::max(size, static_cast<std::size_t>(stated)));
  if (pixels.size() < size)
    throw LoadError(fmt::format("the KTX2 file's pixels have {} bytes where {} belong", pixels.size(), size));

  Image image{header.width, height, std::vector<std::uint8_t>(std::size_t{4} * header.width * height)};
  for (std::size_t y = 0; y < height; ++y) {
    const std::byte* row = pixels.data() + (header.upwards ? height - 1 - y : y) * header.width * pixelBytes;
    std::uint8_t* target = image.rgba.data() + 4 * y * header.width;
    for (std::size_t x = 0; x < header.width; ++x)
      for (std::size_t c = 0; c < 4; ++c) target[4 * x + c] = channel(row + x * pixelBytes, format, header.swizzle[c]);
  }
  return image;
}

} // namespace vitrail::tool
