// Image files that state more than they hold. The fuzzer found both.
#include "scene/image_decode.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/load.h"

namespace vitrail::tool {
namespace {

std::string refusal(const std::vector<std::uint8_t>& file) {
  try {
    decodeImage(std::as_bytes(std::span(file)));
  } catch (const LoadError& error) {
    return error.what();
  }
  return "it was read";
}

// Any number of bytes 0xff may stand before a JPEG's markers. The table has 16 times 17 symbols, more than 256.
TEST(DecodeImage, TablesOfAJpegBehindFillBytesAreLookedAt) {
  std::vector<std::uint8_t> file{0xff, 0xff, 0xff, 0xd8, 0xff, 0xc4, 0x01, 0x23, 0x11};
  file.insert(file.end(), 16, 0x11);
  file.resize(400, 0);
  EXPECT_EQ(refusal(file), "the image cannot be decoded: a Huffman table of the JPEG has too many symbols");
}

// The decoder would take a gigabyte for the second chunk.
TEST(DecodeImage, ChunksOfAPngLieWithinTheFile) {
  std::vector<std::uint8_t> file{0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a, 0, 0,
                                 0,    13,  'I', 'H', 'D',  'R',  0,    0,    0, 1};
  file.insert(file.end(), {0, 0, 0, 1, 8, 6, 0, 0, 0, 0x1f, 0x15, 0xc4, 0x89});
  file.insert(file.end(), {0x40, 0, 0, 0, 'I', 'D', 'A', 'T', 0x78, 0xda});
  EXPECT_EQ(refusal(file), "the image cannot be decoded: the PNG is cut off");
}

} // namespace
} // namespace vitrail::tool
