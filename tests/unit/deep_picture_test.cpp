// Pictures of more than 8 bits, read back by the libraries that other programs use.
#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <half.h>
#include <png.h>

#include <cstring>

#include <gtest/gtest.h>

#include "image/exr_encode.h"
#include "image/png_encode.h"

namespace vitrail::tests {
namespace {

using namespace vitrail::tool;

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(const std::vector<std::byte>& bytes) : Imf::IStream("memory"), bytes_(bytes) {}
  bool read(char* to, int count) override {
    if (at_ + static_cast<std::size_t>(count) > bytes_.size()) throw std::runtime_error("the file ends early");
    std::memcpy(to, bytes_.data() + at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override { at_ = position; }

 private:
  const std::vector<std::byte>& bytes_;
  std::size_t at_ = 0;
};

std::uint16_t bitsOf(float value) { return half(value).bits(); }

// Three by two pixels, among them one brighter than white.
DeepPicture linearPicture(bool hasAlpha) {
  DeepPicture picture{3, 2, hasAlpha, Encoding::Linear, {}};
  for (int i = 0; i < 6; ++i) {
    const float value = 0.25F * static_cast<float>(i);
    for (const float channel : {value, 2.0F * value, 4.0F * value, hasAlpha ? 0.5F : 1.0F}) {
      picture.rgba.push_back(bitsOf(channel));
    }
  }
  return picture;
}

// The blue numbers of a file.
std::vector<float> blueOf(Imf::InputFile& file) {
  std::vector<float> blue(6);
  Imf::FrameBuffer buffer;
  buffer.insert("B", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(blue.data()), sizeof(float), 3 * sizeof(float)));
  file.setFrameBuffer(buffer);
  file.readPixels(0, 1);
  return blue;
}

TEST(Exr, HoldsHalvesOrFloatsWithAlphaWhereThereIsSome) {
  for (const bool hasAlpha : {false, true}) {
    for (const ExrNumbers numbers : {ExrNumbers::Half, ExrNumbers::Float}) {
      const std::vector<std::byte> bytes = encodeExr(linearPicture(hasAlpha), numbers);
      EXPECT_EQ(bytes, encodeExr(linearPicture(hasAlpha), numbers));
      MemoryInput stream(bytes);
      Imf::InputFile file(stream, 0);
      const Imf::ChannelList& channels = file.header().channels();
      const Imf::PixelType type = numbers == ExrNumbers::Half ? Imf::HALF : Imf::FLOAT;
      for (const char* name : {"R", "G", "B"}) {
        ASSERT_NE(channels.findChannel(name), nullptr);
        EXPECT_EQ(channels.findChannel(name)->type, type);
      }
      EXPECT_EQ(channels.findChannel("A") != nullptr, hasAlpha);
      ASSERT_TRUE(Imf::hasChromaticities(file.header()));
      EXPECT_NEAR(Imf::chromaticities(file.header()).red.x, 0.64F, 1e-6F);
      EXPECT_EQ(blueOf(file), (std::vector<float>{0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F}));
    }
  }
}

TEST(Png16, HoldsAllBits) {
  DeepPicture picture{2, 1, true, Encoding::Srgb16, {1, 2, 3, 65535, 0x1234, 0x5678, 0x9abc, 0xdef0}};
  const std::vector<std::byte> bytes = encodePng(picture);
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  struct Source {
    const std::byte* at;
  } source{bytes.data()};
  png_set_read_fn(png, &source, [](png_structp reader, png_bytep to, std::size_t count) {
    auto* from = static_cast<Source*>(png_get_io_ptr(reader));
    std::memcpy(to, from->at, count);
    from->at += count;
  });
  png_read_info(png, info);
  EXPECT_EQ(png_get_bit_depth(png, info), 16);
  EXPECT_EQ(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB_ALPHA);
  std::vector<std::uint8_t> row(16);
  png_read_row(png, row.data(), nullptr);
  png_destroy_read_struct(&png, &info, nullptr);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(row[2 * i] << 8 | row[2 * i + 1], picture.rgba[i]) << i; // big-endian

  picture.hasAlpha = false;
  const std::vector<std::byte> plain = encodePng(picture);
  EXPECT_EQ(static_cast<int>(plain[24]), 16);
  EXPECT_EQ(static_cast<int>(plain[25]), PNG_COLOR_TYPE_RGB);
}

} // namespace
} // namespace vitrail::tests
