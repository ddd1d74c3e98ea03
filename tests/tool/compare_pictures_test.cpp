// `vitrail compare A.png B.png` as a user meets it.
#include <gtest/gtest.h>

#include <png.h>

#include <algorithm>
#include <fstream>

#include "png_reader.h"
#include "vitrail.h"

namespace vitrail::tests {
namespace {

// A grey picture with one pixel of another grey, written by libpng's simplified interface.
void writePng(const std::string& path, std::uint32_t width, std::uint32_t height, std::uint8_t grey,
              std::uint8_t special) {
  std::vector<std::uint8_t> rgba(std::size_t{width} * height * 4, grey);
  for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;
  const std::size_t at = (std::size_t{5} * width + 7) * 4; // (7, 5)
  std::fill_n(rgba.begin() + static_cast<std::ptrdiff_t>(at), 3, special);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGBA;
  ASSERT_NE(png_image_write_to_file(&image, path.c_str(), 0, rgba.data(), 0, nullptr), 0);
}

TEST(ComparePictures, TableReportAndHeatmap) {
  const TemporaryFolder folder;
  writePng(folder.file("a.png"), 20, 10, 100, 100);
  writePng(folder.file("b.png"), 20, 10, 100, 160);
  const ProcessResult result = vitrail(folder, {"compare", "a.png", "b.png", "--json", "r.json", "--heatmap", "h.png"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(folder.names(), (Words{"a.png", "b.png", "h.png", "r.json"}));
  // 10 log10(255^2 * 200 / 60^2)
  EXPECT_NE(result.out.find("35.58"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("60/255   at 7,5"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("0.5 %"), std::string::npos) << result.out;

  const Json json = readJson(folder.file("r.json"));
  EXPECT_EQ(json.at("expected"), "a.png");
  EXPECT_EQ(json.at("test"), "b.png");
  EXPECT_EQ(json.at("width"), 20);
  EXPECT_EQ(json.at("height"), 10);
  EXPECT_NEAR(json.at("psnr_db").get<double>(), 35.578079, 1e-5);
  EXPECT_LT(json.at("ssim"), 1.0);
  EXPECT_GT(json.at("flip"), 0.0);
  EXPECT_EQ(json.at("worst"), (Json{{"x", 7}, {"y", 5}, {"difference", 60}}));
  EXPECT_DOUBLE_EQ(json.at("off_share").get<double>(), 0.005);

  const ReadPng heatmap = readPng(folder.file("h.png"));
  ASSERT_EQ(heatmap.width, 20U);
  ASSERT_EQ(heatmap.height, 10U);
  // Brightest where the pictures differ, black in the far corner.
  const auto brightness = [&](std::size_t x, std::size_t y) {
    const std::uint8_t* pixel = &heatmap.rgba[(y * 20 + x) * 4];
    return int{pixel[0]} + int{pixel[1]} + int{pixel[2]};
  };
  for (std::size_t x = 0; x < 20; ++x) EXPECT_LE(brightness(x, 5), brightness(7, 5)) << x;
  EXPECT_GT(brightness(7, 5), 100);
  EXPECT_EQ(brightness(19, 9), 4); // magma's first colour
}

TEST(ComparePictures, EqualPictures) {
  const TemporaryFolder folder;
  writePng(folder.file("a.png"), 12, 12, 9, 200);
  const ProcessResult result = vitrail(folder, {"compare", "a.png", "a.png", "--json", "/dev/stdout"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const Json json = Json::parse(result.out); // and nothing else
  EXPECT_TRUE(json.at("psnr_db").is_null());
  EXPECT_NEAR(json.at("ssim").get<double>(), 1.0, 1e-12);
  EXPECT_EQ(json.at("flip"), 0.0);
  EXPECT_EQ(json.at("worst").at("difference"), 0);
  EXPECT_NE(vitrail(folder, {"compare", "a.png", "a.png"}).out.find("inf"), std::string::npos);
  EXPECT_EQ(vitrail(folder, {"compare", "a.png", "a.png", "--quiet"}).out, "");
}

TEST(ComparePictures, WhatCannotBeComparedIsOneLine) {
  const TemporaryFolder folder;
  writePng(folder.file("a.png"), 20, 10, 100, 100);
  writePng(folder.file("b.png"), 10, 20, 100, 100);
  std::ofstream(folder.file("text.png")) << "no picture";
  std::ofstream(folder.file("empty.png"));
  const std::string bytes = readText(folder.file("a.png"));
  std::ofstream(folder.file("half.png"), std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  std::filesystem::create_directory(folder.path() / "folder.png");
  const std::vector<std::tuple<Words, int, std::string>> cases = {
      {{"a.png", "b.png"}, 1, "20x10"},
      {{"a.png", "text.png"}, 1, "text.png: is not a PNG"},
      {{"a.png", "empty.png"}, 1, "empty.png: is empty"},
      {{"half.png", "a.png"}, 1, "half.png"},
      {{"a.png", "folder.png"}, 1, "folder.png: is a directory"},
      {{"a.png", "none.png"}, 1, "none.png: no such file"},
      {{"a.png", "a.png", "--json", "nowhere/r.json"}, 1, "nowhere"},
      {{"a.png"}, 2, "compare it with"},
      {{"a.png", "b.png", "c.png"}, 2, "two pictures are compared"},
      {{"a.png", "model.glb"}, 2, "a.png is a picture"},
      {{"a.png", "b.png", "--clip-plane", "1,0,0,0"}, 2, "--clip-plane"},
      {{"a.png", "b.png", "--eye", "1,0,0"}, 2, "--eye"},
      {{"a.png", "b.png", "--size", "10x10"}, 2, "--size"},
      {{"a.png", "b.png", "-o", "folder"}, 2, "--output"},
      {{"a.png", "b.png", "--layers", "4"}, 2, "--layers is for comparing methods"},
      {{"a.png", "b.png", "--passes", "4"}, 2, "--passes is for comparing methods"},
      {{"a.png", "b.png", "--scene", "spheres"}, 2, "--scene"},
      {{"a.png", "b.png", "--json", "x", "--heatmap", "x"}, 2, "same file"},
      {{"a.png", "b.png", "--heatmap", "./a.png"}, 2, "written over"},
      {{}, 2, "nothing to draw"},
      {{"--scene", "spheres", "--heatmap", "h.png"}, 2, "--heatmap"},
      {{"--scene", "spheres", "--methods", "sorting"}, 2, "sorting"},
      {{"--scene", "spheres", "--samples", "3"}, 2, "1, 2, 4 or 8"},
      {{"--scene", "spheres", "--layers", "0"}, 2, "--layers"},
      {{"--scene", "spheres", "--passes", "many"}, 2, "--passes"},
      {{"--scene", "spheres", "--methods", "unsorted,loop", "--passes", "9"}, 2, "unsorted has no choice"},
  };
  for (const std::string& tool : kTools) {
    for (auto [arguments, exitCode, reason] : cases) {
      arguments.insert(arguments.begin(), "compare");
      expectRefusal(folder, tool, arguments, exitCode, reason);
    }
  }
}

} // namespace
} // namespace vitrail::tests
