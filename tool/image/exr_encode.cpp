#include "exr_encode.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <half.h>

#include <array>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

namespace vitrail::tool {

namespace {

// What OpenEXR writes, in memory.
class MemoryStream : public Imf::OStream {
 public:
  explicit MemoryStream(std::vector<std::byte>& bytes) : Imf::OStream("the picture"), bytes_(bytes) {}

  void write(const char* data, int size) override {
    const std::size_t count = static_cast<std::size_t>(size);
    if (at_ + count > bytes_.size()) bytes_.resize(at_ + count);
    std::memcpy(bytes_.data() + at_, data, count);
    at_ += count;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = position; }

 private:
  std::vector<std::byte>& bytes_;
  std::size_t at_ = 0;
};

constexpr std::array<const char*, 4> kChannels{"R", "G", "B", "A"};

Imf::Header headerOf(const DeepPicture& picture, Imf::PixelType type) {
  Imf::Header header(static_cast<int>(picture.width), static_cast<int>(picture.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities()); // Rec. 709, and its white
  const std::size_t channels = picture.hasAlpha ? 4 : 3;
  for (std::size_t i = 0; i < channels; ++i) header.channels().insert(kChannels[i], Imf::Channel(type));
  return header;
}

// Writes interleaved RGBA numbers. OpenEXR takes what it only reads by a pointer to something that may change.
template <class Number>
std::vector<std::byte> encode(const DeepPicture& picture, Imf::PixelType type, Number* rgba) {
  std::vector<std::byte> bytes;
  try {
    MemoryStream stream(bytes);
    const Imf::Header header = headerOf(picture, type);
    Imf::FrameBuffer pixels;
    const std::size_t channels = picture.hasAlpha ? 4 : 3;
    for (std::size_t i = 0; i < channels; ++i) {
      pixels.insert(kChannels[i], Imf::Slice(type, reinterpret_cast<char*>(rgba + i), 4 * sizeof(Number),
                                             4 * sizeof(Number) * picture.width));
    }
    Imf::OutputFile file(stream, header, 0); // no threads
    file.setFrameBuffer(pixels);
    file.writePixels(static_cast<int>(picture.height));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string("the EXR could not be encoded: ") + error.what());
  }
  return bytes;
}

} // namespace

std::vector<std::byte> encodeExr(const DeepPicture& picture, ExrNumbers numbers) {
  if (numbers == ExrNumbers::Half) {
    std::vector<std::uint16_t> halves = picture.rgba;
    return encode(picture, Imf::HALF, halves.data());
  }
  std::vector<float> floats(picture.rgba.size());
  for (std::size_t i = 0; i < floats.size(); ++i) {
    half number;
    number.setBits(picture.rgba[i]);
    floats[i] = number;
  }
  return encode(picture, Imf::FLOAT, floats.data());
}

} // namespace vitrail::tool
