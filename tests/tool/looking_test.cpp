// What of models is seen, and from where: turned models, cameras of the user's, cuts, several models, and pictures that
// show nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "png_reader.h"
#include "vitrail.h"

namespace vitrail::tests {
namespace {

const std::string kCorpus = std::string(VITRAIL_TEST_CORPUS) + "/good/";

using Color = std::array<int, 3>;

// The colour at a share of the width and the height.
Color at(const ReadPng& png, double x, double y) {
  const auto column = static_cast<std::size_t>(x * png.width);
  const auto row = static_cast<std::size_t>(y * png.height);
  const std::uint8_t* pixel = &png.rgba[(row * png.width + column) * 4];
  return {pixel[0], pixel[1], pixel[2]};
}

const Color kWhite{255, 255, 255};

void write(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder.path() / name, std::ios::binary) << text;
}

// On the processor, unless the words name a Vulkan device's options.
ReadPng draw(const TemporaryFolder& folder, Words words) {
  std::string command;
  for (const std::string& word : words) command += " " + word;
  SCOPED_TRACE(command);
  words.insert(words.begin(), "render");
  if (std::ranges::find(words, "--validate") == words.end()) words.insert(words.end(), {"--device", "cpu"});
  words.insert(words.end(), {"--size", "64x64", "-o", "a.png"});
  const ProcessResult result = vitrail(folder, words);
  EXPECT_EQ(result.exitCode, 0) << result.error;
  return result.exitCode == 0 ? readPng(folder.file("a.png")) : ReadPng{1, 1, false, {0, 0, 0, 0}};
}

// A rectangle in the plane z = 0 from (-1, -1) to (1, 1), with a colour at every corner.
std::string square(const std::string& color, float x = 0.0F, float y = 0.0F, float z = 0.0F) {
  std::string text;
  for (const auto& [cornerX, cornerY] : {std::pair{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}}) {
    text += "v " + std::to_string(x + cornerX) + " " + std::to_string(y + cornerY) + " " + std::to_string(z) + " " +
            color + "\n";
  }
  return text + "f 1 2 3 4\n";
}

bool isReddish(const Color& color) { return color[0] > color[1] + 40 && color[0] > color[2] + 40; }
bool isBluish(const Color& color) { return color[2] > color[1] + 40 && color[2] > color[0] + 40; }

// Red above, blue below, for a file whose up axis is z.
TEST(Looking, TheUpAxisOfTheFile) {
  const TemporaryFolder folder;
  // A wall in the plane y = 0, seen from -y, which is the front of such files: red where z is 1.
  write(folder, "z.obj", "v -1 0 -1 0 0 1\nv 1 0 -1 0 0 1\nv 1 0 1 1 0 0\nv -1 0 1 1 0 0\nf 1 2 3 4\n");
  const ReadPng z = draw(folder, {"z.obj", "--up", "z", "--orbit", "0,0"});
  EXPECT_TRUE(isReddish(at(z, 0.5, 0.15))) << at(z, 0.5, 0.15)[0];
  EXPECT_TRUE(isBluish(at(z, 0.5, 0.85)));
  write(folder, "x.obj", "v -1 -1 0 0 0 1\nv -1 1 0 0 0 1\nv 1 1 0 1 0 0\nv 1 -1 0 1 0 0\nf 1 2 3 4\n");
  const ReadPng x = draw(folder, {"x.obj", "--up", "x", "--orbit", "0,0"});
  EXPECT_TRUE(isReddish(at(x, 0.5, 0.15)));
  EXPECT_TRUE(isBluish(at(x, 0.5, 0.85)));
  // A file's camera turns with it: the same is seen, though in another light.
  const std::string model = kCorpus + "cameras.gltf";
  const ReadPng upright = draw(folder, {model, "--camera", "0", "--background", "transparent"});
  const ReadPng turned = draw(folder, {model, "--camera", "0", "--background", "transparent", "--up", "z"});
  std::size_t covered = 0;
  for (std::size_t i = 3; i < upright.rgba.size(); i += 4) {
    EXPECT_EQ(upright.rgba[i], turned.rgba[i]) << i;
    covered += upright.rgba[i] > 0 ? 1 : 0;
  }
  EXPECT_GT(covered, 20U);
}

TEST(Looking, FromAPlaceInTheFilesOwnCoordinates) {
  const TemporaryFolder folder;
  write(folder, "a.obj",
        square("1 0 0", -2.0F) + "v 1 -1 0 0 0 1\nv 3 -1 0 0 0 1\nv 3 1 0 0 0 1\nv 1 1 0 0 0 1\nf 5 6 7 8\n");
  const ReadPng both = draw(folder, {"a.obj", "--eye", "0,0,8"}); // the middle of the model is 0,0,0
  EXPECT_TRUE(isReddish(at(both, 0.2, 0.5)));
  EXPECT_TRUE(isBluish(at(both, 0.8, 0.5)));
  EXPECT_EQ(at(both, 0.5, 0.5), kWhite);
  const ReadPng red = draw(folder, {"a.obj", "--eye", "-2,0,3", "--look-at", "-2,0,0", "--fov", "30"});
  EXPECT_TRUE(isReddish(at(red, 0.05, 0.05)));
  EXPECT_TRUE(isReddish(at(red, 0.95, 0.95)));
  // From behind they change sides; wider, they are smaller.
  EXPECT_TRUE(isBluish(at(draw(folder, {"a.obj", "--eye", "0,0,-8"}), 0.2, 0.5)));
  EXPECT_EQ(at(draw(folder, {"a.obj", "--eye", "0,0,8", "--fov", "120"}), 0.2, 0.5), kWhite);
  // With another up axis, places are still the file's.
  const ReadPng turned = draw(folder, {"a.obj", "--up", "z", "--eye", "-2,0,3", "--look-at", "-2,0,0", "--fov", "30"});
  EXPECT_TRUE(isReddish(at(turned, 0.5, 0.5)));
}

TEST(Looking, PlanesCutModelsOpen) {
  const TemporaryFolder folder;
  write(folder, "red.obj", square("1 0 0", 10.0F, 20.0F));
  const Words view = {"red.obj", "--eye", "10,20,4"};
  const auto cut = [&](const Words& planes, const Words& options = {}) {
    Words words = view;
    for (const std::string& plane : planes) {
      words.emplace_back("--clip-plane");
      words.push_back(plane);
    }
    words.insert(words.end(), options.begin(), options.end());
    return draw(folder, words);
  };
  // Opaque and transparent surfaces, on the processor and by Vulkan.
  for (const Words& options :
       {Words{}, Words{"--opacity", "0.9"}, Words{"--validate"}, Words{"--opacity", "0.9", "--validate"}}) {
    const ReadPng whole = cut({}, options);
    EXPECT_TRUE(isReddish(at(whole, 0.3, 0.3)) && isReddish(at(whole, 0.7, 0.7)));
    const ReadPng right = cut({"1,0,0,10"}, options); // x >= 10
    EXPECT_EQ(at(right, 0.3, 0.5), kWhite);
    EXPECT_EQ(at(right, 0.7, 0.5), at(whole, 0.7, 0.5));
    const ReadPng corner = cut({"2,0,0,20", "0,-1,0,-20"}, options); // and y <= 20
    EXPECT_EQ(at(corner, 0.7, 0.3), kWhite);
    EXPECT_EQ(at(corner, 0.3, 0.7), kWhite);
    EXPECT_EQ(at(corner, 0.7, 0.7), at(whole, 0.7, 0.7));
    EXPECT_TRUE(cut({"1,0,0,-100"}, options).rgba == whole.rgba); // which cuts nothing
  }
}

// A pane, of which every method draws the same half.
TEST(Looking, PlanesCutForEveryMethod) {
  const TemporaryFolder folder;
  write(folder, "a.obj", square("1 0 0"));
  const ProcessResult result =
      vitrail(folder, {"compare", "a.obj", "--opacity", "0.5", "--clip-plane", "1,0,0,0.1", "--orbit", "0,0", "--size",
                       "32x32", "--repeat", "1", "--warmup", "1", "--validate", "--json", "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const Json report = readJson(folder.file("a.json"));
  std::size_t methods = 0;
  for (const Json& method : report.at("methods")) {
    const std::string name = method.at("method");
    if (name == "stochastic") continue; // noise
    EXPECT_EQ(method.at("metrics").at("off_share"), 0.0) << method;
    ++methods;
  }
  EXPECT_GE(methods, 10U);
}

TEST(Looking, SeveralModelsInOnePicture) {
  const TemporaryFolder folder;
  write(folder, "red.obj", square("1 0 0", -2.0F));
  write(folder, "blue.obj", square("0 0 1", 2.0F) + "mtllib none.mtl\n");
  const ReadPng both = draw(folder, {"red.obj", "blue.obj", "--orbit", "0,0"});
  EXPECT_TRUE(isReddish(at(both, 0.2, 0.5)));
  EXPECT_TRUE(isBluish(at(both, 0.8, 0.5)));
  for (const std::string& tool : kTools) {
    expectRefusal(folder, tool, {"render", "red.obj", "none.obj", "-o", "b.png"}, 1, "none.obj: no such file");
  }
}

// ---- Pictures that show nothing

// One warning that says so, in the line and in the report, and an error under --strict.
void expectNothingSeen(const TemporaryFolder& folder, Words words, const std::string& reason) {
  const Words pictures = {"--size", "64x64", "-o", "empty.png", "--json", "empty.json"};
  words.insert(words.begin(), "render");
  words.insert(words.end(), pictures.begin(), pictures.end());
  const ProcessResult result = vitrail(folder, words);
  SCOPED_TRACE(words[1]);
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const std::string line = "nothing of the model is seen: " + reason;
  EXPECT_NE(result.error.find("vitrail: warning: " + line + "\n"), std::string::npos) << result.error;
  const Json warnings = readJson(folder.file("empty.json")).at("warnings");
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings.back(), line);
  std::filesystem::remove(folder.path() / "empty.png");
  std::filesystem::remove(folder.path() / "empty.json");
  words.emplace_back("--strict");
  expectRefusal(folder, kTool, words, 1, "nothing of the model is seen");
}

TEST(Looking, PicturesThatShowNothingSayWhy) {
  const TemporaryFolder folder;
  expectNothingSeen(folder, {kCorpus + "triangle.gltf", "--orbit", "180,0"},
                    "its surfaces are single-sided and face away from the camera");
  write(folder, "d0.obj", "mtllib d0.mtl\nusemtl glass\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n");
  write(folder, "d0.mtl", "newmtl glass\nd 0\n");
  expectNothingSeen(folder, {"d0.obj"}, "all of it is wholly transparent (alpha 0)");
  write(folder, "alpha_0.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 9 9 9 0\n1 0 0 9 9 9 0\n0 1 0 9 9 9 0\n3 0 1 2\n");
  expectNothingSeen(folder, {"alpha_0.ply"}, "all of it is wholly transparent (alpha 0)");
  write(folder, "a.obj", square("1 0 0"));
  for (const char* background : {"#ffffff", "sky", "transparent"}) {
    expectNothingSeen(folder, {"a.obj", "--eye", "0,0,4", "--look-at", "0,0,5", "--background", background},
                      "it lies behind the camera");
  }
  expectNothingSeen(folder, {"a.obj", "--eye", "0,0,4", "--look-at", "9,0,4", "--opacity", "0.5"},
                    "the camera looks elsewhere");
  expectNothingSeen(folder, {"a.obj", "--clip-plane", "0,0,1,1"}, "the clip planes cut all of it away");
}

TEST(Looking, WhatIsSeenHasNoWarning) {
  const TemporaryFolder folder;
  write(folder, "a.obj", square("1 0 0"));
  for (const char* background : {"#ffffff", "sky", "transparent"}) {
    for (const char* samples : {"1", "4"}) {
      const ProcessResult result = vitrail(folder, {"render", "a.obj", "--size", "32x32", "--samples", samples,
                                                    "--background", background, "--strict", "-o", "a.png"});
      EXPECT_EQ(result.exitCode, 0) << result.error;
    }
  }
}

TEST(Looking, CompareAndBenchWarnToo) {
  const TemporaryFolder folder;
  write(folder, "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 9 9 9 0\n1 0 0 9 9 9 0\n0 1 0 9 9 9 0\n3 0 1 2\n");
  for (const char* command : {"compare", "bench"}) {
    const ProcessResult result =
        vitrail(folder, {command, "a.ply", "--size", "16x16", "--repeat", "1", "--methods", "unsorted"});
    EXPECT_EQ(result.exitCode, 1); // there is nothing to measure
    EXPECT_TRUE(result.error.starts_with("vitrail: warning: nothing of the model is seen: all of it is wholly "))
        << command << result.error;
  }
}

// Something is drawn, and it makes no difference.
TEST(Looking, ATriangleOfTheBackgroundsColour) {
  const TemporaryFolder folder;
  write(folder, "white.gltf",
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "extensionsUsed":["KHR_materials_unlit"],
        "materials":[{"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]},
                      "extensions":{"KHR_materials_unlit":{}}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,
          "uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  const std::string reason = "it is too faint, too thin or of the background's colour";
  expectNothingSeen(folder, {"white.gltf"}, reason);
  const Words compare = {"compare", "white.gltf", "--size",   "16x16",  "--repeat",
                         "1",       "--methods",  "unsorted", "--json", "a.json"};
  const ProcessResult result = vitrail(folder, compare);
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_NE(result.error.find(reason), std::string::npos) << result.error;
  EXPECT_EQ(readJson(folder.file("a.json")).at("warnings").size(), 1U);
}

TEST(Looking, WrongUsageIsOneLine) {
  const Words scene = {"render", "--scene", "spheres", "-o", "a.png"};
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"--up", "w"}, "y, z and x"},
      {{"--eye", "1,2"}, "X,Y,Z"},
      {{"--eye", "1,2,inf"}, "X,Y,Z"},
      {{"--look-at", "1,2,3"}, "--eye"},
      {{"--eye", "1,2,3", "--look-at", "here"}, "--look-at"},
      {{"--eye", "1,2,3", "--look-at", "1,2,3"}, "one place"},
      {{"--eye", "1,2,3", "--orbit", "0,0"}, "exclude"},
      {{"--eye", "1,2,3", "--camera", "0"}, "exclude"},
      {{"--fov", "45", "--camera", "0"}, "--fov"},
      {{"--fov", "0"}, "1 and 170"},
      {{"--fov", "180"}, "1 and 170"},
      {{"--fov", "nan"}, "--fov"},
      {{"--clip-plane", "1,0,0"}, "A,B,C,D"},
      {{"--clip-plane", "0,0,0,1"}, "direction"},
      {{"--clip-plane", "1,0,0,nan"}, "A,B,C,D"},
  };
  for (const std::string& tool : kTools) {
    for (const auto& [options, reason] : cases) {
      Words words = scene;
      words.insert(words.end(), options.begin(), options.end());
      expectRefusal(tool, words, 2, reason);
    }
    Words many = scene;
    for (int i = 0; i < 9; ++i) many.insert(many.end(), {"--clip-plane", "1,0,0,0"});
    expectRefusal(tool, many, 2, "at most 8");
  }
}

} // namespace
} // namespace vitrail::tests
