// What pictures are written as, and where to: 16-bit PNG, OpenEXR, standard output, the pictures of a turn, films.
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "png_reader.h"
#include "vitrail.h"

namespace vitrail::tests {
namespace {

namespace fs = std::filesystem;

// On the processor, unless a test asks for Vulkan.
const Words kOnProcessor = {"--device", "cpu"};
const Words kByVulkan = {"--validate"};

Words scene(const Words& more, const Words& device = kOnProcessor) {
  Words words = {"render", "--scene", "interlocked", "--size", "96x64"};
  words.insert(words.end(), device.begin(), device.end());
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

int bitsOf(const std::string& png) { return png.size() > 24 ? png[24] : 0; }

bool isExr(const std::string& bytes) { return bytes.starts_with("\x76\x2f\x31\x01"); }

class OutputsOf : public ::testing::TestWithParam<Words> {};

INSTANTIATE_TEST_SUITE_P(Devices, OutputsOf, ::testing::Values(kOnProcessor, kByVulkan),
                         [](const auto& device) { return device.param == kByVulkan ? "Vulkan" : "Processor"; });

TEST_P(OutputsOf, SixteenBits) {
  const TemporaryFolder folder;
  ASSERT_EQ(vitrail(folder, scene({"-o", "a.png"}, GetParam())).exitCode, 0);
  const ProcessResult result = vitrail(folder, scene({"-o", "b.png", "--bits", "16"}, GetParam()));
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(bitsOf(readText(folder.path() / "a.png")), 8);
  EXPECT_EQ(bitsOf(readText(folder.path() / "b.png")), 16);
  const ReadPng eight = readPng(folder.file("a.png"));
  const ReadPng sixteen = readPng(folder.file("b.png")); // as 8 bits
  int largest = 0;
  for (std::size_t i = 0; i < eight.rgba.size(); ++i)
    largest = std::max(largest, std::abs(eight.rgba[i] - sixteen.rgba[i]));
  EXPECT_LE(largest, 1);
}

TEST_P(OutputsOf, OpenExr) {
  const TemporaryFolder folder;
  for (const char* background : {"#ffffff", "transparent"}) {
    for (const char* bits : {"16", "32"}) {
      const ProcessResult result =
          vitrail(folder, scene({"-o", "a.exr", "--bits", bits, "--background", background}, GetParam()));
      ASSERT_EQ(result.exitCode, 0) << result.error;
      const std::string bytes = readText(folder.path() / "a.exr");
      EXPECT_TRUE(isExr(bytes));
      // The list of channels: a name, its end, and the kind of its numbers.
      const std::string kind = bits == std::string("16") ? std::string("\1", 1) : std::string("\2", 1);
      EXPECT_NE(bytes.find(std::string("B\0", 2) + kind), std::string::npos);
      EXPECT_EQ(bytes.find(std::string("A\0", 2) + kind) < bytes.find("chromaticities"),
                background == std::string("transparent"));
    }
  }
  EXPECT_EQ(folder.names(), Words{"a.exr"});
}

TEST(Outputs, StandardOutputTakesThePictureAlone) {
  const TemporaryFolder folder;
  ASSERT_EQ(vitrail(folder, scene({"-o", "a.png"})).exitCode, 0);
  const ProcessResult png = vitrail(folder, scene({"-o", "-"}));
  ASSERT_EQ(png.exitCode, 0) << png.error;
  EXPECT_TRUE(png.out == readText(folder.path() / "a.png"));
  EXPECT_NE(png.error.find("96x64, "), std::string::npos) << png.error; // the line is beside it
  const ProcessResult exr = vitrail(folder, scene({"-o", "-", "--format", "exr", "--quiet"}));
  EXPECT_TRUE(isExr(exr.out));
  EXPECT_EQ(exr.error, "");
  EXPECT_EQ(folder.names(), Words{"a.png"});
}

TEST(Outputs, ATerminalTakesNoPicture) {
  const TemporaryFolder folder;
  const std::string shown = onTerminal(folder, "render --scene planes --size 16x16 -o -");
  EXPECT_NE(shown.find("standard output is a terminal"), std::string::npos) << shown;
}

TEST_P(OutputsOf, ATurnIsOnePictureAStep) {
  const TemporaryFolder folder;
  const Words turn = {"-o", "turn_%03d.png", "--turntable", "4", "--orbit", "10,20", "--json", "turn.json"};
  const ProcessResult result = vitrail(folder, scene(turn, GetParam()));
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(folder.names(), (Words{"turn.json", "turn_000.png", "turn_001.png", "turn_002.png", "turn_003.png"}));
  EXPECT_TRUE(result.out.starts_with("turn_000.png to turn_003.png: 4 pictures of 96x64, ")) << result.out;
  const std::string first = readText(folder.path() / "turn_000.png");
  for (const char* other : {"turn_001.png", "turn_002.png", "turn_003.png"}) {
    EXPECT_EQ(readPng(folder.file(other)).width, 96U);
    EXPECT_FALSE(readText(folder.path() / other) == first) << other;
  }
  const Json json = readJson(folder.file("turn.json"));
  ASSERT_EQ(json.at("frames").size(), 4U);
  EXPECT_EQ(json.at("frames").at(1).at("file"), "turn_001.png");
  EXPECT_EQ(json.at("frames").at(1).at("exact"), true);
  EXPECT_EQ(json.at("warnings").size(), 0U);
}

TEST(Outputs, ATurnThatShowsNothingIsSaidOnce) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const Words words = {"render", "a.obj",        "--size",  "32x32", "--turntable",
                       "3",      "--clip-plane", "0,0,1,1", "-o",    "%d.png"};
  const ProcessResult result = vitrail(folder, words);
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_NE(result.error.find("the clip planes cut all of it away"), std::string::npos) << result.error;
  EXPECT_EQ(folder.names(), (Words{"0.png", "1.png", "2.png", "a.obj"}));
  for (const char* name : {"0.png", "1.png", "2.png"}) fs::remove(folder.path() / name);
  Words strict = words;
  strict.emplace_back("--strict");
  expectRefusal(folder, kTool, strict, 1, "nothing of the model is seen");
}

// A program in place of ffmpeg.
std::string fakeFfmpeg(const TemporaryFolder& folder, const std::string& script) {
  const fs::path bin = folder.path() / "bin";
  fs::create_directory(bin);
  std::ofstream(bin / "ffmpeg") << "#!/bin/sh\n" << script;
  ::chmod((bin / "ffmpeg").c_str(), 0755);
  return "PATH=" + bin.string() + ":/usr/bin:/bin";
}

ProcessResult film(const TemporaryFolder& folder, const std::string& path, const Words& more = {}) {
  Words words = scene({"--turntable", "3", "-o", "turn.mp4"});
  words.insert(words.end(), more.begin(), more.end());
  return vitrail(words, {.folder = folder.path(), .environment = {path}, .running = {}});
}

TEST(Outputs, AFilmIsWhatFfmpegMakesOfThePictures) {
  const TemporaryFolder folder;
  const std::string path = fakeFfmpeg(folder, "for last; do :; done\nprintf '%s\\n' \"$@\" > words\ncat > \"$last\"\n");
  const ProcessResult result = film(folder, path);
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_TRUE(result.out.starts_with("turn.mp4: 3 pictures of 96x64")) << result.out;
  EXPECT_EQ(folder.names(), (Words{"bin", "turn.mp4", "words"}));
  EXPECT_NE(readText(folder.path() / "words").find("\n96x64\n"), std::string::npos);
  const std::string film = readText(folder.path() / "turn.mp4");
  ASSERT_EQ(film.size(), std::size_t{3} * 96 * 64 * 4);
  // The second picture is that of a turn in files.
  ASSERT_EQ(vitrail(folder, scene({"--turntable", "3", "-o", "%d.png"})).exitCode, 0);
  const ReadPng second = readPng(folder.file("1.png"));
  EXPECT_TRUE(film.substr(second.rgba.size(), second.rgba.size()) ==
              std::string(second.rgba.begin(), second.rgba.end()));
}

TEST(Outputs, AFilmThatFailsLeavesNothing) {
  for (const char* script :
       {"cat > /dev/null\necho 'no such codec' >&2\nexit 1\n", "echo 'no such codec' >&2\nexit 1\n"}) {
    const TemporaryFolder folder;
    const std::string path = fakeFfmpeg(folder, script);
    std::ofstream(folder.path() / "turn.mp4") << "an older film";
    const ProcessResult result = film(folder, path);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_EQ(result.error, "vitrail: error: cannot write turn.mp4: ffmpeg says: no such codec\n");
    EXPECT_EQ(folder.names(), (Words{"bin", "turn.mp4"}));
    EXPECT_EQ(readText(folder.path() / "turn.mp4"), "an older film");
  }
}

TEST(Outputs, WithoutFfmpegAFilmIsRefusedAtOnce) {
  const TemporaryFolder folder;
  const ProcessResult result = film(folder, "PATH=" + folder.path().string());
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_NE(result.error.find("ffmpeg"), std::string::npos);
  EXPECT_NE(result.error.find("frame_%04d.png"), std::string::npos) << result.error;
  EXPECT_EQ(folder.names(), Words{});
}

TEST(Outputs, WrongUsageIsOneLine) {
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"-o", "a.jpg"}, ".png or .exr"},
      {{"-o", "a"}, ".png or .exr"},
      {{"-o", "a.png", "--format", "exr"}, "--format"},
      {{"-o", "a.png", "--format", "bmp"}, "png and exr"},
      {{"-o", "a.png", "--bits", "32"}, "8 or 16"},
      {{"-o", "a.png", "--bits", "0"}, "--bits"},
      {{"-o", "a.exr", "--bits", "8"}, "16 or 32"},
      {{"-o", "a.mp4"}, "--turntable"},
      {{"-o", "a.png", "--turntable", "4"}, "frame_%04d.png"},
      {{"-o", "a_%s.png", "--turntable", "4"}, "frame_%04d.png"},
      {{"-o", "a_%d_%d.png", "--turntable", "4"}, "frame_%04d.png"},
      {{"-o", "-", "--turntable", "4"}, "frame_%04d.png"},
      {{"-o", "%d.png", "--turntable", "0"}, "--turntable"},
      {{"-o", "%d.png", "--turntable", "4", "--json", "3.png"}, "same file"},
      {{"-o", "%d.png", "--turntable", "4", "--camera", "0"}, "--camera"},
      {{"-o", "a.mp4", "--turntable", "4", "--size", "95x64"}, "even"},
      {{"-o", "a.mp4", "--turntable", "4", "--bits", "16"}, "8 bits"},
  };
  for (const std::string& tool : kTools) {
    for (const auto& [options, reason] : cases) {
      Words words = {"render", "--scene", "spheres"};
      words.insert(words.end(), options.begin(), options.end());
      expectRefusal(tool, words, 2, reason);
    }
  }
}

TEST(Outputs, InfoOfAModelNeedsNoDevice) {
  const TemporaryFolder folder;
  const std::string model = std::string(VITRAIL_TEST_CORPUS) + "/good/transmission.gltf";
  const ProcessOptions noDriver{.folder = folder.path(),
                                .environment = {"VK_ICD_FILENAMES=/none.json", "VK_DRIVER_FILES=/none.json"},
                                .running = {}};
  const ProcessResult text = vitrail({"info", model}, noDriver);
  ASSERT_EQ(text.exitCode, 0) << text.error;
  EXPECT_TRUE(text.out.starts_with(model + "\n")) << text.out;
  EXPECT_NE(text.out.find("transmission 1"), std::string::npos) << text.out;
  const ProcessResult json = vitrail({"info", model, model, "--json"}, noDriver);
  ASSERT_EQ(json.exitCode, 0) << json.error;
  EXPECT_EQ(Json::parse(json.out).at("models").size(), 2U);
  for (const std::string& tool : kTools) {
    expectRefusal(tool, {"info", "none.glb"}, 1, "none.glb: no such file");
    expectRefusal(tool, {"info", "--json"}, 2, "--json");
  }
}

} // namespace
} // namespace vitrail::tests
