// PNG (ISO/IEC 15948), written by several threads: strips of rows are filtered and compressed each for itself, and make
// one stream together. The file is the same for any number of threads.
#include "png_encode.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

#include "../scene/threads.h"

namespace vitrail::tool {

namespace {

constexpr std::size_t kStripBytes = std::size_t{1} << 18U; // of rows, about: small enough for the caches
constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::uint8_t kPaeth = 4;
constexpr std::uint8_t kRgb = 2;
constexpr std::uint8_t kRgbAlpha = 6;

using Bytes = std::vector<std::uint8_t>;

// The pixels of a picture, and how they stand in a file.
struct Source {
  std::uint32_t width;
  std::uint32_t height;
  bool hasAlpha;
  std::uint32_t channelBytes;
  const std::uint8_t* rgba; // in the machine's order of bytes

  [[nodiscard]] std::size_t pixelBytes() const { return std::size_t{hasAlpha ? 4U : 3U} * channelBytes; }
  [[nodiscard]] std::size_t rowBytes() const { return width * pixelBytes(); }
};

void putBig(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

// A file of chunks, whose size is known from the beginning.
class File {
 public:
  explicit File(std::size_t size) : bytes_(size) { put(kSignature.data(), kSignature.size()); }

  void add(const char* type, const Bytes& data) {
    Bytes number;
    putBig(number, static_cast<std::uint32_t>(data.size()));
    putBig(number, static_cast<std::uint32_t>(checksum(type, data)));
    put(number.data(), 4);
    put(type, 4);
    put(data.data(), data.size());
    put(number.data() + 4, 4);
  }

  static std::size_t sizeOf(const Bytes& data) { return data.size() + 12; }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  static uLong checksum(const char* type, const Bytes& data) {
    const uLong ofType = ::crc32(0, reinterpret_cast<const Bytef*>(type), 4);
    return data.empty() ? ofType : ::crc32(ofType, data.data(), static_cast<uInt>(data.size()));
  }
  void put(const void* data, std::size_t size) {
    if (size > 0) std::memcpy(bytes_.data() + end_, data, size);
    end_ += size;
  }

  std::vector<std::byte> bytes_;
  std::size_t end_ = 0;
};

// A row as it stands in a file: without alpha where there is none, and big-endian.
void takeRow(const Source& source, std::uint32_t y, std::uint8_t* row) {
  const std::size_t channels = source.hasAlpha ? 4 : 3;
  if (source.channelBytes == 1) {
    const std::uint8_t* from = source.rgba + std::size_t{y} * source.width * 4;
    if (source.hasAlpha) {
      std::memcpy(row, from, source.rowBytes());
      return;
    }
    for (std::size_t x = 0; x < source.width; ++x) {
      for (std::size_t channel = 0; channel < 3; ++channel) row[3 * x + channel] = from[4 * x + channel];
    }
    return;
  }
  const std::uint16_t* from = reinterpret_cast<const std::uint16_t*>(source.rgba) + std::size_t{y} * source.width * 4;
  for (std::size_t x = 0; x < source.width; ++x) {
    for (std::size_t channel = 0; channel < channels; ++channel) {
      const std::uint16_t value = from[4 * x + channel];
      *row++ = static_cast<std::uint8_t>(value >> 8U);
      *row++ = static_cast<std::uint8_t>(value);
    }
  }
}

// Takes from each byte what its neighbours at the left, above and between them make one expect.
void filterPaeth(const std::uint8_t* row, const std::uint8_t* above, std::size_t bytes, std::size_t pixel,
                 std::uint8_t* filtered) {
  for (std::size_t i = 0; i < pixel; ++i) filtered[i] = static_cast<std::uint8_t>(row[i] - above[i]);
  for (std::size_t i = pixel; i < bytes; ++i) {
    const auto a = static_cast<std::int16_t>(row[i - pixel]);
    const auto b = static_cast<std::int16_t>(above[i]);
    const auto c = static_cast<std::int16_t>(above[i - pixel]);
    const auto toA = static_cast<std::int16_t>(b > c ? b - c : c - b);
    const auto toB = static_cast<std::int16_t>(a > c ? a - c : c - a);
    const auto sum = static_cast<std::int16_t>(a + b - 2 * c);
    const auto toC = static_cast<std::int16_t>(sum > 0 ? sum : -sum);
    const std::int16_t bOrC = toB <= toC ? b : c;
    const std::int16_t expected = toA <= std::min(toB, toC) ? a : bOrC;
    filtered[i] = static_cast<std::uint8_t>(row[i] - expected);
  }
}

// Some rows, filtered. One filter for all: it leaves runs of few values in rendered pictures.
Bytes filterRows(const Source& source, std::uint32_t first, std::uint32_t end) {
  const std::size_t size = source.rowBytes();
  Bytes result((size + 1) * (end - first));
  Bytes above(size);
  Bytes row(size);
  if (first > 0) takeRow(source, first - 1, above.data());
  std::uint8_t* to = result.data();
  for (std::uint32_t y = first; y < end; ++y, to += size + 1) {
    takeRow(source, y, row.data());
    *to = kPaeth;
    filterPaeth(row.data(), above.data(), size, source.pixelBytes(), to + 1);
    std::swap(row, above);
  }
  return result;
}

// A part of a stream of deflate. Runs alone are looked for: no search for longer matches finds much more.
Bytes compress(const Bytes& data, bool isLast) {
  z_stream stream{};
  if (deflateInit2(&stream, 1, Z_DEFLATED, -MAX_WBITS, 9, Z_RLE) != Z_OK) throw std::bad_alloc();
  Bytes result(deflateBound(&stream, static_cast<uLong>(data.size())) + 16);
  stream.next_in = const_cast<Bytef*>(data.data()); // it is not written to
  stream.avail_in = static_cast<uInt>(data.size());
  stream.next_out = result.data();
  stream.avail_out = static_cast<uInt>(result.size());
  const int status = deflate(&stream, isLast ? Z_FINISH : Z_SYNC_FLUSH);
  result.resize(stream.total_out);
  result.shrink_to_fit(); // many wait for each other
  deflateEnd(&stream);
  if (status != (isLast ? Z_STREAM_END : Z_OK)) throw std::runtime_error("the PNG could not be compressed");
  return result;
}

struct Strip {
  Bytes data; // compressed
  uLong adler = 0;
  std::size_t bytes = 0; // before
};

std::vector<Strip> makeStrips(const Source& source) {
  const auto rows =
      static_cast<std::uint32_t>(std::clamp<std::size_t>(kStripBytes / source.rowBytes(), 1, source.height));
  std::vector<Strip> strips((source.height + rows - 1) / rows);
  std::atomic<std::uint32_t> next{0};
  inParts(partsFor(strips.size(), 1), [&](std::size_t) {
    for (std::uint32_t i = next++; i < strips.size(); i = next++) {
      const Bytes filtered = filterRows(source, i * rows, std::min((i + 1) * rows, source.height));
      strips[i] = {compress(filtered, i + 1 == strips.size()),
                   ::adler32(1, filtered.data(), static_cast<uInt>(filtered.size())), filtered.size()};
    }
  });
  return strips;
}

Bytes headerOf(const Source& source) {
  Bytes header;
  putBig(header, source.width);
  putBig(header, source.height);
  header.push_back(static_cast<std::uint8_t>(8 * source.channelBytes));
  header.push_back(source.hasAlpha ? kRgbAlpha : kRgb);
  header.insert(header.end(), 3, 0); // deflate, the usual filters, not interlaced
  return header;
}

std::vector<std::byte> encode(const Source& source) {
  std::vector<Strip> strips = makeStrips(source);
  uLong adler = 1;
  for (const Strip& strip : strips) adler = adler32_combine(adler, strip.adler, static_cast<z_off_t>(strip.bytes));
  strips.front().data.insert(strips.front().data.begin(), {0x78, 0x01}); // of zlib: a window of 32 KiB
  putBig(strips.back().data, static_cast<std::uint32_t>(adler));

  const Bytes header = headerOf(source);
  const Bytes intent{0}; // perceptual
  std::size_t size = kSignature.size() + File::sizeOf(header) + File::sizeOf(intent) + File::sizeOf({});
  for (const Strip& strip : strips) size += File::sizeOf(strip.data);
  File file(size);
  file.add("IHDR", header);
  file.add("sRGB", intent);
  for (Strip& strip : strips) {
    file.add("IDAT", strip.data);
    strip.data = {};
  }
  file.add("IEND", {});
  return file.take();
}

} // namespace

std::vector<std::byte> encodePng(const Picture& picture) {
  return encode({picture.width, picture.height, picture.hasAlpha, 1, picture.rgba.data()});
}

std::vector<std::byte> encodePng(const DeepPicture& picture) {
  return encode(
      {picture.width, picture.height, picture.hasAlpha, 2, reinterpret_cast<const std::uint8_t*>(picture.rgba.data())});
}

} // namespace vitrail::tool
