// The program as a user meets it: what it prints, what it leaves on disk, how it ends. The sanitized build of the same
// program takes every bad option and every bad file.
#include <gtest/gtest.h>

#include <signal.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include "../thorough.h"
#include "png_reader.h"
#include "vitrail.h"

namespace vitrail::tests {
namespace {

namespace fs = std::filesystem;
const std::string kModels = VITRAIL_TEST_MODELS; // assimp-testmodels

// A small picture that is quick to draw.
Words smallRender(const std::string& output) {
  return {"render", "--scene", "interlocked", "--size", "96x64", "--device", "cpu", "-o", output};
}

TEST(Cli, HelpPagesAndVersion) {
  for (const Words& arguments :
       {Words{"--help"}, Words{"render", "--help"}, Words{"info", "--help"}, Words{"scenes", "--help"}, Words{"-h"}}) {
    const ProcessResult result = vitrail(arguments);
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_NE(result.out.find("Usage:"), std::string::npos);
    EXPECT_EQ(result.error, "");
  }
  EXPECT_TRUE(vitrail({"--version"}).out.starts_with("vitrail "));
  const ProcessResult nothing = vitrail({});
  EXPECT_EQ(nothing.exitCode, 2);
  EXPECT_NE(nothing.error.find("Usage:"), std::string::npos);
}

TEST(Cli, TheHelpPageNamesEveryOption) {
  const std::string help = vitrail({"render", "--help"}).out;
  for (const char* option :
       {"--scene",   "--count",      "--seed",          "--size",       "--camera",       "--orbit",
        "--opacity", "--background", "--output",        "-o",           "--json",         "--quiet",
        "--device",  "--validate",   "--method",        "--samples",    "--msaa-resolve", "--nodes",
        "--resolve", "--layers",     "--memory-budget", "--list-build", "--up",           "--eye",
        "--look-at", "--fov",        "--clip-plane",    "--turntable",  "--format",       "--bits",
        "--strict",  "--time",       "--animation",     "--variant",    "--point-size",   "--api"}) {
    EXPECT_NE(help.find(option), std::string::npos) << option;
  }
}

TEST(Cli, TheHelpPageNamesEveryMethodThatThereIs) {
  const std::string help = vitrail({"render", "--help"}).out;
  const std::string names = vitrail({"render", "--scene", "spheres", "-o", "a.png", "--method", "none"}).error;
  const std::string all = names.substr(names.find("methods are ") + 12);
  std::istringstream words(all);
  std::size_t count = 0;
  for (std::string name; words >> name; ++count) {
    if (name.ends_with(',')) name.pop_back();
    EXPECT_NE(help.find("\n    " + name + " "), std::string::npos) << name;
  }
  EXPECT_GT(count, 10U);
}

TEST(Cli, WrongUsageIsOneLineAndExitCode2) {
  const Words scene = {"render", "--scene", "spheres", "-o", "a.png"};
  const auto with = [&](const Words& more) {
    Words all = scene;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"paint"}, "paint"},
      {{"render"}, "nothing to draw"},
      {{"render", "--scene", "spheres"}, "-o"},
      {{"render", "a.glb", "--scene", "spheres", "-o", "a.png"}, "exclude"},
      {{"render", "--scene", "sheres", "-o", "a.png"}, "spheres"},
      {{"render", "a.glb", "--count", "3", "-o", "a.png"}, "--scene"},
      {{"render", "--scene", "spheres", "-o", "a.jpg"}, ".png"},
      {with({"--json", "a.png"}), "same file"},
      {with({"--json", "./a.png"}), "same file"},
      {with({"--opacity", "0.001"}), "--opacity"},
      {with({"--size", "100"}), "--size"},
      {with({"--size", "0x10"}), "--size"},
      {with({"--size", "-5x10"}), "--size"},
      {with({"--size", "10x10x10"}), "--size"},
      {with({"--size", "99999999999x10"}), "--size"},
      {with({"--orbit", "1"}), "--orbit"},
      {with({"--orbit", "1,nan"}), "--orbit"},
      {with({"--orbit", "0,91"}), "elevation"},
      {with({"--orbit", "0,0,0"}), "zoom"},
      {with({"--orbit", "0,0", "--camera", "0"}), "exclude"},
      {with({"--camera", "7"}), "--camera"},
      {with({"--camera", "-1"}), "--camera"},
      {with({"--opacity", "0"}), "--opacity"},
      {with({"--opacity", "1.5"}), "--opacity"},
      {with({"--opacity", "nan"}), "--opacity"},
      {with({"--opacity", "half"}), "--opacity"},
      {with({"--point-size", "0"}), "--point-size"},
      {with({"--point-size", "nan"}), "--point-size"},
      {with({"--point-size", "1e9"}), "--point-size"},
      {with({"--background", "red"}), "--background"},
      {with({"--background", "#12345"}), "--background"},
      {with({"--background", "#12345g"}), "--background"},
      {with({"--background", "#-12345"}), "--background"},
      {with({"--count", "0"}), "1 to 20000"},
      {with({"--count", "1e3"}), "--count"},
      {with({"--count", "4000000000"}), "1 to 20000"},
      {with({"--seed", "-1"}), "--seed"},
      {with({"--nodes", "fat"}), "compact"},
      {with({"--method", "alphabetical"}), "sorted-triangles"},
      {with({"--samples", "3"}), "1, 2, 4 or 8"},
      {with({"--samples", "0"}), "--samples"},
      {with({"--samples", "many"}), "--samples"},
      {with({"--msaa-resolve", "both"}), "per-sample"},
      {with({"--msaa-resolve", "per-sample"}), "--samples 2, 4 or 8"},
      {with({"--msaa-resolve", "per-sample", "--samples", "4", "--resolve", "compute"}), "--resolve fragment"},
      {with({"--samples", "8", "--nodes", "compact"}), "at most 4 samples"},
      {with({"--resolve", "default"}), "--resolve"},
      {with({"--list-build", "late"}), "fragment and compute"},
      {with({"--method", "insertion", "--list-build", "compute"}), "insertion has no choice"},
      {with({"--layers", "0"}), "--layers"},
      {with({"--layers", "-1"}), "--layers"},
      {with({"--memory-budget", "0"}), "--memory-budget"},
      {with({"--memory-budget", "0.5"}), "--memory-budget"},
      {with({"--method", "unsorted", "--nodes", "standard"}), "unsorted has no choice"},
      {with({"--method", "unsorted", "--layers", "4"}), "unsorted has no choice"},
      {with({"--method", "sorted", "--passes", "4"}), "sorted has no choice"},
      {with({"--method", "sorted-triangles", "--memory-budget", "4"}), "sorted-triangles has no choice"},
      {with({"--method", "unsorted", "--resolve", "compute"}), "unsorted has no choice"},
      {with({"--method", "insertion", "--nodes", "compact"}), "insertion has no choice"},
      {with({"--method", "insertion", "--samples", "4"}), "one sample"},
      {with({"--method", "unsorted", "--memory-budget", "1"}), "--memory-budget"},
      {with({"--size"}), "--size"},
      {with({"--time", "soon"}), "--time"},
      {with({"--time", "nan"}), "--time"},
      {with({"--time", "1"}), "a built-in scene has none"},
      {with({"--animation", "0"}), "a built-in scene has none"},
      {with({"--variant", "red"}), "a built-in scene has none"},
  };
  for (const auto& [arguments, reason] : cases) {
    for (const std::string& tool : kTools) expectRefusal(tool, arguments, 2, reason);
  }
}

TEST(Cli, WhatCannotBeDoneIsOneLineAndExitCode1) {
  for (const std::string& tool : kTools) {
    expectRefusal(tool, {"render", "no-such-file.glb", "-o", "a.png"}, 1, "no-such-file.glb");
    expectRefusal(tool, {"render", "/", "-o", "a.png"}, 1, "/");
    expectRefusal(tool, {"render", "/etc/passwd", "-o", "a.png"}, 1, ".gltf");
    expectRefusal(tool, {"render", "--scene", "spheres", "-o", "nowhere/a.png"}, 1, "nowhere");
    expectRefusal(tool, {"render", "--scene", "spheres", "-o", "a.png", "--json", "nowhere/a.json"}, 1, "nowhere");
  }
  expectRefusal(kTool, {"render", "--scene", "spheres", "-o", "a.png", "--device", "abacus"}, 1, "abacus");
  expectRefusal(kTool, {"render", "--scene", "spheres", "-o", "a.png", "--device", "99"}, 1, "99");
  expectRefusal(kTool, {"render", "--scene", "spheres", "-o", "a.png", "--size", "65536x1", "--device", "0"}, 1,
                "too large");
}

TEST(Cli, WhatAModelDoesNotHaveIsRefusedWithWhatItHas) {
  const std::string good = std::string(VITRAIL_TEST_CORPUS) + "/good/";
  for (const std::string& tool : kTools) {
    expectRefusal(tool, {"render", good + "variants.gltf", "--variant", "dusk", "-o", "a.png"}, 1,
                  "\"day\", \"night\"");
    expectRefusal(tool, {"render", good + "triangle.gltf", "--time", "0", "-o", "a.png"}, 1, "holds no animations");
    expectRefusal(tool, {"bench", good + "animations.gltf", "--animation", "fly"}, 1, "\"walk\"");
    expectRefusal(tool, {"bench", "--scene", "spheres", "--time", "1"}, 2, "a built-in scene has none");
    expectRefusal(tool, {"compare", good + "variants.gltf", "--variant", "dusk"}, 1, "\"day\"");
  }
}

TEST(Cli, EveryBadFileOfTheCorpusIsRefused) {
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(VITRAIL_TEST_CORPUS) / "bad")) {
    if (!entry.is_regular_file()) continue;
    expectRefusal(kSanitizedTool, {"render", entry.path().string(), "-o", "a.png"}, 1,
                  entry.path().filename().string());
    ++files;
  }
  EXPECT_GE(files, 30U);
}

TEST(Cli, InfoAndScenesListWhatThereIs) {
  const ProcessResult info = vitrail({"info"});
  EXPECT_EQ(info.exitCode, 0) << info.error;
  EXPECT_NE(info.out.find("driver"), std::string::npos);
  const ProcessResult scenes = vitrail({"scenes"});
  EXPECT_EQ(scenes.exitCode, 0);
  for (const char* name : {"spheres", "planes", "interlocked", "mannequins", "hairball", "smoke", "flames"}) {
    EXPECT_NE(scenes.out.find(name), std::string::npos) << name;
  }
}

TEST(Cli, APictureAndItsReport) {
  const TemporaryFolder folder;
  const Words arguments = {"render",     "--scene", "interlocked", "--size", "96x64",
                           "--validate", "-o",      "a.png",       "--json", "a.json"};
  const ProcessResult result = vitrail(folder, arguments);
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(folder.names(), (Words{"a.json", "a.png"}));
  EXPECT_TRUE(result.out.starts_with("a.png: 96x64, ")) << result.out;

  const ReadPng png = readPng(folder.file("a.png"));
  EXPECT_EQ(png.width, 96U);
  EXPECT_EQ(png.height, 64U);
  EXPECT_FALSE(png.hasAlpha);
  std::set<std::array<std::uint8_t, 3>> colors;
  for (std::size_t i = 0; i < png.rgba.size(); i += 4) colors.insert({png.rgba[i], png.rgba[i + 1], png.rgba[i + 2]});
  EXPECT_GT(colors.size(), 100U); // lit surfaces over each other

  const auto json = readJson(folder.file("a.json"));
  EXPECT_TRUE(json.at("device").is_string());
  EXPECT_TRUE(json.at("api").is_string());
  EXPECT_EQ(json.at("method"), "linked-list");
  EXPECT_EQ(json.at("width"), 96);
  EXPECT_EQ(json.at("height"), 64);
  EXPECT_EQ(json.at("samples"), 1);
  EXPECT_EQ(json.at("nodes"), "hdr");
  EXPECT_TRUE(json.at("resolve") == "compute" || json.at("resolve") == "fragment") << json.at("resolve");
  EXPECT_EQ(json.at("msaa_resolve"), nullptr);
  EXPECT_EQ(json.at("exact"), true);
  EXPECT_GT(json.at("error_bound_255"), 0.5);
  EXPECT_LE(json.at("error_bound_255"), 1.0);
  EXPECT_EQ(json.at("approximate_pixels"), 0);
  EXPECT_EQ(json.at("tiles"), 1);
  const auto& fragments = json.at("fragments");
  EXPECT_GT(fragments.at("requested"), 0);
  EXPECT_EQ(fragments.at("stored"), fragments.at("requested"));
  EXPECT_EQ(fragments.at("missing"), 0);
  EXPECT_GT(json.at("layers").at("max"), 1);
  EXPECT_GT(json.at("layers").at("mean"), 1.0);
  EXPECT_LE(json.at("layers").at("mean"), json.at("layers").at("max"));
  EXPECT_GE(json.at("memory").at("nodes_bytes").get<std::uint64_t>(), 12 * fragments.at("stored").get<std::uint64_t>());
  EXPECT_EQ(json.at("memory").at("heads_bytes"), 96 * 64 * 4);
  EXPECT_GT(json.at("memory").at("total_bytes"), json.at("memory").at("nodes_bytes"));
  EXPECT_GE(json.at("memory").at("peak_bytes"), json.at("memory").at("total_bytes"));
  for (const char* pass : {"opaque", "clear", "collect", "resolve", "statistics", "encode"}) {
    EXPECT_GE(json.at("passes_ms").at(pass).get<double>(), 0.0) << pass;
  }
  EXPECT_GT(json.at("frame_ms"), 0.0);
}

// A picture and what its report says.
struct Drawn {
  ReadPng png;
  Json report;
};

// Draws a small picture with some options, under the validation layer.
Drawn draw(const Words& options, const std::string& scene = "interlocked", const std::string& size = "96x64",
           const std::string& background = "transparent") {
  std::string command;
  for (const std::string& option : options) command += " " + option;
  SCOPED_TRACE(scene + command);
  const TemporaryFolder folder;
  Words arguments = {"render", "--scene", scene, "--size", size, "--background", background, "--validate"};
  arguments.insert(arguments.end(), {"-o", "a.png", "--json", "a.json"});
  arguments.insert(arguments.end(), options.begin(), options.end());
  const ProcessResult result = vitrail(folder, arguments);
  EXPECT_EQ(result.exitCode, 0) << result.error;
  if (result.exitCode != 0) return {};
  return {readPng(folder.file("a.png")), readJson(folder.file("a.json"))};
}

int largestDifference(const ReadPng& a, const ReadPng& b) {
  if (a.rgba.size() != b.rgba.size()) return 256;
  int largest = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) largest = std::max(largest, std::abs(a.rgba[i] - b.rgba[i]));
  return largest;
}

TEST(Cli, BothResolvesGiveOnePicture) {
  for (const char* samples : {"1", "4"}) {
    const Drawn compute = draw({"--samples", samples, "--resolve", "compute"});
    const Drawn fragment = draw({"--samples", samples, "--resolve", "fragment"});
    EXPECT_EQ(compute.report.at("resolve"), "compute");
    EXPECT_EQ(fragment.report.at("resolve"), "fragment");
    EXPECT_LE(largestDifference(compute.png, fragment.png), 1) << samples << " samples";
    EXPECT_EQ(compute.report.at("fragments"), fragment.report.at("fragments"));
  }
}

TEST(Cli, BothListBuildsGiveOnePictureButForRounding) {
  for (const char* samples : {"1", "4"}) {
    const Drawn fragment = draw({"--samples", samples, "--list-build", "fragment"});
    const Drawn compute = draw({"--samples", samples, "--list-build", "compute"});
    EXPECT_EQ(fragment.report.at("list_build"), "fragment");
    EXPECT_EQ(compute.report.at("list_build"), "compute");
    EXPECT_FALSE(fragment.report.at("passes_ms").contains("build lists"));
    EXPECT_TRUE(compute.report.at("passes_ms").contains("build lists"));
    EXPECT_LE(largestDifference(compute.png, fragment.png), samples == std::string("1") ? 3 : 0) << samples;
    EXPECT_EQ(compute.report.at("fragments"), fragment.report.at("fragments"));
  }
}

TEST(Cli, BothMsaaResolvesGiveOnePicture) {
  const Drawn one = draw({});
  const Drawn pixels = draw({"--samples", "4"});
  const Drawn samples = draw({"--samples", "4", "--msaa-resolve", "per-sample"});
  EXPECT_EQ(pixels.report.at("samples"), 4);
  EXPECT_EQ(pixels.report.at("msaa_resolve"), "per-pixel");
  EXPECT_EQ(samples.report.at("msaa_resolve"), "per-sample");
  EXPECT_EQ(samples.report.at("resolve"), "fragment");
  EXPECT_TRUE(samples.report.at("passes_ms").contains("box_filter"));
  EXPECT_FALSE(pixels.report.at("passes_ms").contains("box_filter"));
  EXPECT_LE(largestDifference(pixels.png, samples.png), 1);
  EXPECT_GT(largestDifference(pixels.png, one.png), 20) << "edges are smoother";
  EXPECT_GT(pixels.report.at("fragments").at("stored"), one.report.at("fragments").at("stored"));
}

TEST(Cli, NodeFormatsDifferInTheirRounding) {
  const Drawn standard = draw({"--nodes", "standard"});
  const Drawn hdr = draw({"--nodes", "hdr"});
  const Drawn compact = draw({"--nodes", "compact"});
  const auto nodeBytes = [](const Drawn& drawn) {
    return drawn.report.at("memory").at("nodes_bytes").get<std::uint64_t>();
  };
  EXPECT_EQ(hdr.report.at("nodes"), "hdr");
  EXPECT_EQ(compact.report.at("nodes"), "compact");
  EXPECT_EQ(3 * nodeBytes(hdr), 4 * nodeBytes(standard)); // 16 bytes a node and 12
  EXPECT_EQ(3 * nodeBytes(compact), 2 * nodeBytes(standard));
  EXPECT_LE(largestDifference(standard.png, hdr.png), 10); // where alpha is small, colours divided by it
  EXPECT_GT(largestDifference(standard.png, hdr.png), 0);
  EXPECT_LE(largestDifference(standard.png, compact.png), 60);
  EXPECT_GT(largestDifference(standard.png, compact.png), 3);
}

TEST(Cli, ACapThatIsHitIsReported) {
  const Drawn all = draw({});
  const auto deepest = all.report.at("layers").at("max").get<std::uint32_t>();
  const Drawn capped = draw({"--layers", "2"});
  EXPECT_EQ(capped.report.at("exact"), false);
  EXPECT_GT(capped.report.at("approximate_pixels"), 0);
  EXPECT_GT(largestDifference(all.png, capped.png), 0);
  const Drawn roomy = draw({"--layers", std::to_string(deepest)});
  EXPECT_EQ(roomy.report.at("exact"), true);
  EXPECT_EQ(roomy.report.at("approximate_pixels"), 0);
  EXPECT_EQ(largestDifference(all.png, roomy.png), 0);
}

TEST(Cli, EveryMemoryBudgetGivesTheSamePicture) {
  const Words ways[] = {{"--samples", "1"},
                        {"--resolve", "fragment"},
                        {"--samples", "4"},
                        {"--samples", "4", "--msaa-resolve", "per-sample"}};
  for (Words options : ways) {
    const bool isEitherEnd = options == ways[0] || options == ways[3];
    if (!isEitherEnd && !tests::isThorough()) continue;
    const Drawn whole = draw(options, "smoke", "256x192");
    EXPECT_EQ(whole.report.at("tiles"), 1);
    options.insert(options.end(), {"--memory-budget", ""});
    std::vector<std::uint32_t> tiles;
    for (const std::uint32_t budget : {1U, 4U}) {
      options.back() = std::to_string(budget);
      const Drawn tiled = draw(options, "smoke", "256x192");
      EXPECT_TRUE(tiled.png.rgba == whole.png.rgba) << options[1] << " within " << budget << " MiB";
      EXPECT_EQ(tiled.report.at("exact"), true);
      EXPECT_EQ(tiled.report.at("fragments"), whole.report.at("fragments"));
      EXPECT_EQ(tiled.report.at("layers"), whole.report.at("layers"));
      const std::uint64_t bytes = std::uint64_t{budget} << 20U;
      EXPECT_LE(tiled.report.at("memory").at("total_bytes").get<std::uint64_t>(), bytes + 256U) << "and statistics";
      tiles.push_back(tiled.report.at("tiles"));
    }
    EXPECT_GE(tiles.front(), 2U);
    EXPECT_EQ(tiles.back(), 1U);
  }
}

// Where transparent surfaces cover only a part of the picture, or none of it, tiles cover only that part.
TEST(Cli, AMemoryBudgetForLittleOrNothing) {
  const Words away = {"--orbit", "0,0,0.02"};
  Words budget = away;
  budget.insert(budget.end(), {"--memory-budget", "1"});
  const Drawn small = draw(budget);
  EXPECT_TRUE(small.png.rgba == draw(away).png.rgba);
  EXPECT_EQ(small.report.at("tiles"), 1); // it fits: the library's budget bounds the pool
  EXPECT_LE(small.report.at("memory").at("total_bytes"), 1 << 20);

  const TemporaryFolder folder;
  const std::string opaque = std::string(VITRAIL_TEST_CORPUS) + "/good/tangents.gltf";
  for (const char* samples : {"1", "4"}) {
    const Words whole = {"render", opaque, "--size", "96x64", "--samples", samples, "--validate", "-o", "whole.png"};
    Words tiled = whole;
    tiled.back() = "tiled.png";
    tiled.insert(tiled.end(), {"--memory-budget", "1"});
    for (const Words& arguments : {whole, tiled}) {
      const ProcessResult result = vitrail(folder, arguments);
      EXPECT_EQ(result.exitCode, 0) << result.error;
    }
    EXPECT_EQ(readText(folder.path() / "tiled.png"), readText(folder.path() / "whole.png"));
  }
}

TEST(Cli, UnsortedBlendsInTheOrderOfSubmission) {
  const Drawn exact = draw({});
  for (const char* samples : {"1", "4"}) {
    const Drawn unsorted = draw({"--method", "unsorted", "--samples", samples});
    EXPECT_EQ(unsorted.report.at("method"), "unsorted");
    EXPECT_EQ(unsorted.report.at("exact"), false);
    for (const char* none : {"fragments", "layers", "nodes", "resolve", "msaa_resolve"}) {
      EXPECT_EQ(unsorted.report.at(none), nullptr) << none;
    }
    EXPECT_EQ(unsorted.report.at("memory").at("nodes_bytes"), 0);
    const auto& passes = unsorted.report.at("passes_ms");
    EXPECT_TRUE(passes.contains("opaque") && passes.contains("blend") && passes.contains("encode")) << passes;
    EXPECT_EQ(passes.contains("box_filter"), std::string(samples) == "4");
    EXPECT_FALSE(passes.contains("collect")) << passes;
    EXPECT_GT(largestDifference(unsorted.png, exact.png), 20) << "the scene has no right order";
  }
  // Where the order does not matter it is the same picture, up to the rounding of what is stored: unsorted rounds the
  // picture to 16-bit floats at each surface.
  const auto flames = [](const Words& options) { return draw(options, "flames", "96x64", "#000000").png; };
  EXPECT_LE(largestDifference(flames({"--method", "unsorted"}), flames({"--nodes", "hdr"})), 2);
}

// What the method, and not the file's reader, knows to be missing.
TEST(Cli, WhatAMethodDrawsOtherwiseIsWarnedOf) {
  const TemporaryFolder folder;
  Words words = {"render", VITRAIL_TEST_CORPUS "/good/volume.gltf", "--size", "32x32", "-o", "a.png", "--json",
                 "a.json"};
  const ProcessResult result = vitrail(folder, words);
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_NE(result.error.find("vitrail: warning: material 0 \"pane\": an object of it is not closed"),
            std::string::npos)
      << result.error;
  EXPECT_EQ(readJson(folder.file("a.json")).at("warnings").size(), 1U);
  words[5] = "strict.png";
  words.emplace_back("--strict");
  EXPECT_EQ(vitrail(folder, words).exitCode, 1);
  EXPECT_FALSE(std::filesystem::exists(folder.file("strict.png")));
}

TEST(Cli, AModelIsNeverWrittenOver) {
  const TemporaryFolder folder;
  const std::filesystem::path model = folder.file("m.gltf");
  std::filesystem::copy_file(VITRAIL_TEST_CORPUS "/good/triangle.gltf", model);
  const auto size = std::filesystem::file_size(model);
  for (const Words& outputs : {Words{"-o", "a.png", "--json", "./m.gltf"}, Words{"-o", "m.gltf", "--format", "png"}}) {
    Words words = {"render", "m.gltf", "--size", "16x16"};
    words.insert(words.end(), outputs.begin(), outputs.end());
    const ProcessResult result = vitrail(folder, words);
    EXPECT_EQ(result.exitCode, 2) << result.error;
    EXPECT_NE(result.error.find("would be written over"), std::string::npos) << result.error;
    EXPECT_EQ(std::filesystem::file_size(model), size);
  }
}

// Sample counts are the device's: those of lavapipe are 1 and 4.
TEST(Cli, ASampleCountThatTheDeviceLacksIsRefusedByName) {
  const std::string info = vitrail({"info"}).out;
  const std::size_t at = info.find("samples", info.find("  0  "));
  ASSERT_NE(at, std::string::npos) << info;
  const std::string line = info.substr(at, info.find('\n', at) - at);
  for (const std::string samples : {"2", "4", "8"}) {
    if (line.find(samples) != std::string::npos) continue;
    for (const char* command : {"render", "compare"}) {
      expectRefusal(kTool, {command, "--scene", "interlocked", "-o", "a.png", "--samples", samples, "--device", "0"}, 1,
                    "not " + samples);
    }
  }
}

// Panes that tint what is behind them: as the hardware blends it, for the panes stand in the right order in the file.
TEST(Cli, TransmissionTintsWhatIsBehind) {
  const std::string model = std::string(VITRAIL_TEST_CORPUS) + "/good/transmission.gltf";
  const TemporaryFolder folder;
  const auto picture = [&](const Words& options) {
    Words arguments = {"render", model, "--size", "160x60", "--validate", "-o", "a.png"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProcessResult result = vitrail(folder, arguments);
    EXPECT_EQ(result.exitCode, 0) << result.error;
    return readPng(folder.file("a.png"));
  };
  const ReadPng blended = picture({"--method", "unsorted"});
  EXPECT_LE(largestDifference(picture({}), blended), 2);
  EXPECT_LE(largestDifference(picture({"--nodes", "hdr"}), blended), 1);
  EXPECT_LE(largestDifference(picture({"--resolve", "fragment"}), blended), 2);
  // The clear pane before the white background, at the left: blue and bright.
  const std::uint8_t* pixel = &blended.rgba[(std::size_t{22} * 160 + 33) * 4];
  EXPECT_LT(pixel[0] + 40, pixel[2]) << int{pixel[0]} << " " << int{pixel[1]} << " " << int{pixel[2]};
  EXPECT_GT(pixel[2], 200);
}

TEST(Cli, TheSamePictureTenTimes) {
  const TemporaryFolder folder;
  std::string first;
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(vitrail(folder, smallRender("a.png")).exitCode, 0);
    const std::string bytes = readText(folder.path() / "a.png");
    if (i == 0) first = bytes;
    EXPECT_TRUE(bytes == first) << "run " << i;
  }
}

TEST(Cli, QuietPrintsNothing) {
  const TemporaryFolder folder;
  Words arguments = smallRender("a.png");
  arguments.push_back("--quiet");
  const ProcessResult result = vitrail(folder, arguments);
  EXPECT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(result.out + result.error, "");
}

TEST(Cli, ATransparentBackgroundMakesAnAlphaChannel) {
  const TemporaryFolder folder;
  Words arguments = smallRender("a.png");
  arguments.insert(arguments.end(), {"--background", "transparent"});
  ASSERT_EQ(vitrail(folder, arguments).exitCode, 0);
  const ReadPng png = readPng(folder.file("a.png"));
  EXPECT_TRUE(png.hasAlpha);
  EXPECT_EQ(png.rgba[3], 0); // the corner shows nothing
  std::uint8_t most = 0;
  for (std::size_t i = 3; i < png.rgba.size(); i += 4) most = std::max(most, png.rgba[i]);
  EXPECT_GT(most, 100);
}

TEST(Cli, TheBackgroundColourReachesThePictureExactly) {
  const TemporaryFolder folder;
  Words arguments = smallRender("a.png");
  arguments.insert(arguments.end(), {"--background", "#0a80fe"});
  ASSERT_EQ(vitrail(folder, arguments).exitCode, 0);
  const ReadPng png = readPng(folder.file("a.png"));
  EXPECT_EQ(png.rgba[0], 0x0a);
  EXPECT_EQ(png.rgba[1], 0x80);
  EXPECT_EQ(png.rgba[2], 0xfe);
}

TEST(Cli, AnOldPictureStaysUntilTheNewOneIsThere) {
  const TemporaryFolder folder;
  const std::string old = "an older picture";
  std::ofstream(folder.path() / "a.png") << old;
  EXPECT_EQ(vitrail(folder, {"render", "no-such-file.glb", "-o", "a.png"}).exitCode, 1);
  EXPECT_EQ(readText(folder.path() / "a.png"), old);
  EXPECT_EQ(vitrail(folder, smallRender("a.png")).exitCode, 0);
  EXPECT_EQ(readPng(folder.file("a.png")).width, 96U);
  EXPECT_EQ(folder.names(), Words{"a.png"});
}

TEST(Cli, ALinkStaysALink) {
  const TemporaryFolder folder;
  fs::create_symlink("real.png", folder.path() / "link.png");
  std::ofstream(folder.path() / "real.png") << "old";
  ASSERT_EQ(vitrail(folder, smallRender("link.png")).exitCode, 0);
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link.png"));
  EXPECT_EQ(readPng(folder.file("real.png")).width, 96U);
}

void expectInterruptLeavesNothing(const std::string& device, std::initializer_list<int> times) {
  for (const int milliseconds : times) {
    const TemporaryFolder folder;
    const auto interrupt = [&](pid_t child) {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      ::kill(child, SIGINT);
    };
    const ProcessResult result =
        vitrail({"render", "--scene", "hairball", "--size", "3840x2160", "--device", device, "-o", "a.png"},
                {.folder = folder.path(), .environment = {}, .running = interrupt});
    if (result.exitCode == 0) continue; // a machine so fast that it was done
    EXPECT_EQ(result.exitCode, 128 + SIGINT) << milliseconds;
    EXPECT_EQ(folder.names(), Words{}) << milliseconds;
  }
}

TEST(Cli, AnInterruptedRenderLeavesNothing) {
  expectInterruptLeavesNothing("llvmpipe", {20, 150, 600, 1500});
  expectInterruptLeavesNothing("cpu", {5, 50, 100, 200, 400});
}

TEST(Cli, AFullDeviceIsAnError) {
  const ProcessResult result = vitrail(smallRender("/dev/full"));
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_NE(result.error.find("No space left on device"), std::string::npos) << result.error;
}

// What goes to standard output is the file and nothing else.
TEST(Cli, StandardOutputCanTakeTheReport) {
  const TemporaryFolder folder;
  Words arguments = smallRender("a.png");
  arguments.insert(arguments.end(), {"--json", "/dev/stdout"});
  const ProcessResult result = vitrail(folder, arguments);
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(Json::parse(result.out).at("exact"), true);
}

TEST(Cli, AMovedProgramNeedsNoFilesBesideIt) {
  const TemporaryFolder folder;
  fs::copy_file(kTool, folder.path() / "moved");
  const ProcessResult result =
      vitrail(folder, {"render", "--scene", "interlocked", "--size", "32x32", "-o", "a.png"}, folder.file("moved"));
  EXPECT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(readPng(folder.file("a.png")).width, 32U);
}

// A real model, as Debian's assimp-testmodels ships it.
TEST(Cli, AnEngineSeenThrough) {
  const TemporaryFolder folder;
  const std::string model = kModels + "/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb";
  const ProcessResult result = vitrail(folder, {"render", model, "--opacity", "0.25", "--size", "320x180", "--validate",
                                                "-o", "engine.png", "--json", "engine.json"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const auto json = readJson(folder.file("engine.json"));
  EXPECT_EQ(json.at("exact"), true);
  EXPECT_GT(json.at("layers").at("max"), 10);
}

} // namespace
} // namespace vitrail::tests
