// The images of glTF files: the kinds that are read, and materials that are drawn without theirs.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "load_good.h"
#include "scene/load.h"
#include "scene/message.h"

namespace vitrail::tool {
namespace {

using Pixels = std::vector<std::uint8_t>;

TEST(LoadImages, OfEveryKind) {
  const Pixels redGreen{255, 0, 0, 255, 0, 255, 0, 128};
  const std::map<std::string, Pixels> expected{
      {"image_webp.gltf", redGreen},
      {"image_webp_plain_source.gltf", redGreen},
      {"image_ktx2.gltf", redGreen},
      {"image_ktx2_zlib.gltf", redGreen},
      {"image_ktx2_zstd.gltf", redGreen},
      {"image_ktx2_grey.gltf", {20, 20, 20, 255, 10, 10, 10, 255}},
      {"image_ktx2_16.gltf", {128, 255, 0, 255}},
      {"image_ktx2_bgr.gltf", {3, 2, 1, 255}},
      {"image_gif.gltf", {255, 0, 0, 255, 0, 255, 0, 255}},
      {"image_basisu_fallback.gltf", redGreen},
  };
  for (const auto& [name, pixels] : expected) {
    SCOPED_TRACE(name);
    const Scene scene = loadGood(name);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    ASSERT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(scene.images[0].rgba, pixels);
    EXPECT_EQ(scene.materials.at(0).baseColorTexture.image, 0);
  }
}

TEST(LoadImages, LossyWebpIsNearItsColour) {
  const Image image = loadGood("image_webp_lossy.gltf").images.at(0);
  ASSERT_EQ(image.width, 8U);
  ASSERT_EQ(image.height, 8U);
  EXPECT_NEAR(image.rgba.at(0), 200, 4);
  EXPECT_NEAR(image.rgba.at(1), 100, 4);
  EXPECT_NEAR(image.rgba.at(2), 50, 4);
}

// What the one warning says, up to the words that all of them end in.
const std::map<std::string, std::string>& expectedWarnings() {
  static const std::map<std::string, std::string> warnings{
      {"avif", "image 0 \"skin\": is an image of the kind AVIF, which is not read"},
      {"basisu_etc1s", "image 0 \"skin\": is Basis Universal (ETC1S), which no library of Debian decodes"},
      {"basisu_uastc",
       "KHR_texture_basisu: image 0 \"skin\": is Basis Universal (UASTC), which no library of Debian decodes"},
      {"both", "image 0 \"skin\": has both of uri and bufferView"},
      {"buffer_view", "image 0: buffer view 0: 10000 bytes at offset 4 reach past the end of buffer 0, which has 140"},
      {"data_uri", "image 0 \"skin\": its data URI holds a character that is not base64"},
      {"dds", "image 0 \"skin\": is an image of the kind DDS, which is not read"},
      {"garbage", "image 0 \"skin\": is no image that can be read: none of PNG, JPEG, WebP, KTX2, GIF, BMP and TGA"},
      {"huge", "image 0 \"skin\": the image states 16000 x 16000 pixels, but its file has only 72 bytes"},
      {"jpeg_table", "image 0 \"skin\": the image cannot be decoded: a Huffman table of the JPEG has too many symbols"},
      {"ktx2_bc7",
       "image 0 \"skin\": is KTX2 of the Vulkan format 145; only plain pixels of 8 or 16 bits a channel are read"},
      {"ktx2_cut_off", "image 0 \"skin\": the KTX2 file is cut off: 8 bytes at offset 144 are stated, but it has 148"},
      {"ktx2_header", "image 0 \"skin\": the KTX2 file ends in its header"},
      {"ktx2_huge", "image 0 \"skin\": the image states 16384 x 16384 pixels, but its file has only 152 bytes"},
      {"ktx2_layers", "image 0 \"skin\": the KTX2 file holds too many layers"},
      {"ktx2_pixels", "image 0 \"skin\": the KTX2 file's pixels have 4 bytes where 8 belong"},
      {"ktx2_scheme", "image 0 \"skin\": the KTX2 file is packed with scheme 9, which is unknown"},
      {"ktx2_zlib", "image 0 \"skin\": the KTX2 file's zlib data are damaged"},
      {"ktx2_zstd", "image 0 \"skin\": the KTX2 file's Zstandard data are damaged"},
      {"missing", "image 0 \"skin\": not-there.png: no such file"},
      {"neither", "image 0 \"skin\": has neither uri nor bufferView"},
      {"outside", "image 0 \"skin\": /dev/zero: is not relative to the model"},
      {"over_limit", "image 0 \"skin\": the image has 100000 x 2 pixels, but a side may have 1 to 16384"},
      {"remote", "image 0 \"skin\": https://example.org/skin.png is not a local file"},
      {"texture", "texture 0: has no image"},
      {"truncated", "image 0 \"skin\": the image cannot be decoded: "},
      {"webp_damaged", "image 0 \"skin\": the image cannot be decoded: its WebP data are damaged or cut off"},
      {"webp_huge", "image 0 \"skin\": the image states 16384 x 16384 pixels, but its file has only 40 bytes"},
  };
  return warnings;
}

TEST(LoadImages, AMaterialWhoseImageIsMissingIsDrawnWithoutItAndOneLineSaysSo) {
  std::size_t seen = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(VITRAIL_TEST_CORPUS) / "good")) {
    const std::string file = entry.path().filename();
    if (!file.starts_with("no_image_")) continue;
    SCOPED_TRACE(file);
    ++seen;
    const std::string name = file.substr(9, file.size() - 9 - 5);
    const Scene scene = loadGood(file);
    ASSERT_TRUE(expectedWarnings().contains(name)) << "the file has no entry in this test";
    ASSERT_EQ(scene.warnings.size(), 1U);
    const std::string& warning = scene.warnings[0];
    EXPECT_TRUE(warning.starts_with(expectedWarnings().at(name))) << warning;
    EXPECT_TRUE(warning.ends_with("; the material is drawn without it")) << warning;
    EXPECT_EQ(warning, printable(warning));
    EXPECT_TRUE(scene.images.empty());
    EXPECT_EQ(scene.materials.at(0).baseColorTexture.image, -1);
    expectNear(scene.materials[0].baseColor, {1, 0.5F, 1, 0.5F});
  }
  EXPECT_EQ(seen, expectedWarnings().size());
}

} // namespace
} // namespace vitrail::tool
