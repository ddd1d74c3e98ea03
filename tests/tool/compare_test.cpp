// `vitrail compare` of transparency methods as a user meets it. The page is opened by tests/page.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "png_reader.h"
#include "vitrail.h"

namespace vitrail::tests {
namespace {

ProcessResult compare(const TemporaryFolder& folder, Words arguments) {
  arguments.insert(arguments.begin(), "compare");
  return vitrail(folder, std::move(arguments));
}

// A small comparison that is quick to draw.
Words smallComparison(const Words& more) {
  Words all{"--scene", "interlocked", "--size", "96x64", "--repeat", "2", "--warmup", "1"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

const Json& methodNamed(const Json& report, const std::string& name) {
  for (const Json& method : report.at("methods")) {
    if (method.at("method") == name) return method;
  }
  throw std::runtime_error("no method " + name);
}

Words namesIn(const Json& list) {
  Words names;
  for (const Json& method : list) names.push_back(method.at("method"));
  return names;
}

TEST(Compare, ReportsEveryMethod) {
  const TemporaryFolder folder;
  const ProcessResult result = compare(folder, smallComparison({"--validate", "-o", "out", "--json", "r.json"}));
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(result.error, ""); // no progress in a pipe
  EXPECT_EQ(folder.names(), (Words{"out", "r.json"}));
  EXPECT_NE(result.out.find("out/index.html"), std::string::npos) << result.out;

  const Json report = readJson(folder.file("r.json"));
  EXPECT_EQ(report, readJson(folder.file("out/report.json")));
  EXPECT_EQ(report.at("scene"), "interlocked");
  EXPECT_TRUE(report.at("count").is_null());
  EXPECT_EQ(report.at("width"), 96);
  EXPECT_EQ(report.at("height"), 64);
  EXPECT_EQ(report.at("samples"), 1);
  EXPECT_EQ(report.at("repeats"), 2);
  EXPECT_EQ(report.at("exact_picture").at("nodes"), "hdr");
  EXPECT_EQ(report.at("exact_picture").at("exact"), true);
  EXPECT_EQ(report.at("exact_picture").at("layers").at("max"), report.at("layers_max"));
  EXPECT_EQ(namesIn(report.at("methods"))[0], "unsorted");
  EXPECT_GE(report.at("methods").size() + report.at("refused").size(), 3U);
  for (const Json& method : report.at("methods")) {
    SCOPED_TRACE(method.dump());
    const std::string name = method.at("method");
    EXPECT_NE(result.out.find("\n " + name + " "), std::string::npos) << result.out;
    EXPECT_GT(method.at("cost_ms").at("median"), 0.0);
    EXPECT_GE(method.at("frame_ms").at("median"), method.at("cost_ms").at("median")); // of cpu they are the same
    EXPECT_GT(method.at("cost_ratio"), 0.0);
    EXPECT_FALSE(method.at("passes_ms").empty());
    for (const std::string& file : {name + ".png", name + "-error.png"}) {
      EXPECT_EQ(readPng(folder.file("out/" + file)).width, 96U) << file;
    }
  }
  EXPECT_EQ(readPng(folder.file("out/exact.png")).height, 64U);
  EXPECT_EQ(readPng(folder.file("out/layers.png")).height, 64U);
  // Blending in no order is visibly wrong here, and lists with 8-bit colours are not.
  const Json& unsorted = methodNamed(report, "unsorted");
  const Json& lists = methodNamed(report, "linked-list");
  EXPECT_DOUBLE_EQ(unsorted.at("cost_ratio"), 1.0);
  EXPECT_EQ(unsorted.at("memory_bytes"), 0);
  EXPECT_GT(unsorted.at("metrics").at("flip"), 0.03);
  EXPECT_GT(unsorted.at("metrics").at("off_share"), 0.03);
  EXPECT_LT(lists.at("metrics").at("flip"), 0.01);
  EXPECT_GT(lists.at("metrics").at("ssim"), 0.999);
  EXPECT_GT(lists.at("memory_bytes"), 96 * 64 * 4);
}

// What the report says of a picture is what `compare` says of the files.
TEST(Compare, FilesAndReportAgree) {
  const TemporaryFolder folder;
  ASSERT_EQ(compare(folder, smallComparison({"--methods", "unsorted", "--quiet", "-o", "out"})).exitCode, 0);
  const Json report = readJson(folder.file("out/report.json"));
  EXPECT_EQ(namesIn(report.at("methods")), Words{"unsorted"});
  ASSERT_EQ(compare(folder, {"out/exact.png", "out/unsorted.png", "--quiet", "--json", "r.json", "--heatmap", "h.png"})
                .exitCode,
            0);
  const Json files = readJson(folder.file("r.json"));
  for (const auto& [name, value] : methodNamed(report, "unsorted").at("metrics").items()) {
    EXPECT_EQ(files.at(name), value) << name;
  }
  EXPECT_EQ(readPng(folder.file("h.png")).rgba, readPng(folder.file("out/unsorted-error.png")).rgba);
}

// What the options or the device do not allow is said, and does not end the run.
TEST(Compare, MethodsThatAreLeftOut) {
  const TemporaryFolder folder;
  const ProcessResult result =
      compare(folder, smallComparison({"--samples", "4", "--methods", "insertion,linked-list", "--json", "r.json"}));
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const Json report = readJson(folder.file("r.json"));
  EXPECT_EQ(namesIn(report.at("methods")), (Words{"unsorted", "linked-list"}));
  ASSERT_EQ(namesIn(report.at("refused")), Words{"insertion"});
  EXPECT_NE(report.at("refused")[0].at("reason").get<std::string>().find("one sample"), std::string::npos);
  EXPECT_NE(result.out.find("left out insertion: "), std::string::npos) << result.out;
  EXPECT_EQ(report.at("samples"), 4);
}

TEST(Compare, ProgressIsShownOnATerminalAlone) {
  const TemporaryFolder folder;
  const std::string command = "compare --scene planes --count 2 --size 32x32 --repeat 1 --methods unsorted ";
  const std::string shown = onTerminal(folder, command);
  EXPECT_NE(shown.find("round 1 of 1"), std::string::npos) << shown;
  EXPECT_NE(shown.find("the exact picture"), std::string::npos) << shown;
  EXPECT_EQ(onTerminal(folder, command + "--quiet"), "");
}

TEST(Compare, WhatCannotBeDoneLeavesNothing) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("file")) << "a file";
  const std::vector<std::tuple<Words, int, std::string>> cases = {
      {smallComparison({"-o", "file"}), 1, "not a folder"},
      {smallComparison({"-o", "nowhere/out"}), 1, "nowhere"},
      {smallComparison({"-o", "out", "--device", "abacus"}), 1, "abacus"},
      {{VITRAIL_TEST_CORPUS "/good/triangle.gltf", "--methods", "unsorted", "-o", "out"}, 1, "--opacity"},
      {{"none.glb", "-o", "out"}, 1, "none.glb"},
      {{"--scene", "spheres", "--size", "65536x1", "-o", "out"}, 1, "too large"},
      {{"--scene", "sheres", "-o", "out"}, 2, "spheres"},
      {{"--scene", "spheres", "--camera", "9", "-o", "out"}, 2, "--camera"},
  };
  for (const auto& [arguments, exitCode, reason] : cases) {
    Words words{"compare"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    expectRefusal(folder, kTool, words, exitCode, reason);
  }
}

// What -o writes cannot be the report of --json too: said before anything is measured.
TEST(Compare, AReportThatTheFolderHasIsRefused) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "out");
  for (const std::string name : {"report.json", "index.html", "exact.png", "unsorted-error.png"}) {
    Words words = smallComparison({"-o", "out", "--json", "./out/" + name});
    words.insert(words.begin(), "compare");
    expectRefusal(folder, kTool, words, 2, "-o writes out/" + name + " itself: leave --json out or name another file");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "out"));
  }
  ASSERT_EQ(compare(folder, smallComparison({"--methods", "unsorted", "-o", "out", "--json", "out/r.json"})).exitCode,
            0);
  EXPECT_EQ(readJson(folder.file("out/r.json")), readJson(folder.file("out/report.json")));
}

// They are of the methods that have them, and the exact picture stays exact.
TEST(Compare, LayersAndPasses) {
  const TemporaryFolder folder;
  const ProcessResult result =
      compare(folder, smallComparison({"--methods", "linked-list,depth-peeling,stochastic", "--layers", "1", "--passes",
                                       "3", "--quiet", "--validate", "-o", "out"}));
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const Json report = readJson(folder.file("out/report.json"));
  const Json none;
  for (const Json& method : report.at("methods")) {
    const std::string name = method.at("method");
    const bool hasLayers = name == "linked-list" || name == "depth-peeling";
    EXPECT_EQ(method.at("max_layers"), hasLayers ? Json(1) : none) << name;
    EXPECT_EQ(method.at("passes"), name == "stochastic" ? Json(3) : none) << name;
    if (hasLayers) {
      EXPECT_EQ(method.at("exact"), false) << name;
      EXPECT_GT(method.at("metrics").at("flip"), 0.01) << name;
    }
  }
  EXPECT_EQ(report.at("methods").size(), 4U);
  EXPECT_EQ(report.at("exact_picture").at("exact"), true);
}

// The device that there is not would be the next thing to be refused: nothing is drawn before.
TEST(Compare, AFolderWhoseFilesCannotBeWrittenIsRefusedBeforeDrawing) {
  for (const std::string name :
       {"report.json", "index.html", "exact.png", "layers.png", "weighted.png", "weighted-error.png", "unsorted.png"}) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "out" / name);
    const Words words{"compare", "--scene", "planes", "-o", "out", "--device", "abacus", "--methods"};
    const auto with = [&words](const std::string& methods) {
      Words all = words;
      all.push_back(methods);
      return all;
    };
    const std::string refusal = "cannot write out/" + name + ": it is a folder";
    expectRefusal(folder, kTool, with("weighted"), 1, refusal);
    const bool isOfWeighted = name.starts_with("weighted"); // which is not written where it is not compared
    expectRefusal(folder, kTool, with("linked-list"), 1, isOfWeighted ? "abacus" : refusal);
  }
}

// A folder that is there keeps what else lies in it, and gets the new files.
TEST(Compare, AFolderThatIsThere) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "out");
  std::ofstream(folder.file("out/notes.txt")) << "mine";
  std::ofstream(folder.file("out/report.json")) << "old";
  ASSERT_EQ(compare(folder, smallComparison({"--methods", "unsorted", "--quiet", "-o", "out/"})).exitCode, 0);
  EXPECT_EQ(readJson(folder.file("out/report.json")).at("width"), 96);
  EXPECT_TRUE(std::filesystem::exists(folder.file("out/notes.txt")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("out/index.html")));
}

TEST(Compare, TheHelpPageNamesEveryOption) {
  const TemporaryFolder folder;
  const ProcessResult result = compare(folder, {"--help"});
  EXPECT_EQ(result.exitCode, 0);
  for (const char* option :
       {"--scene",      "--count",   "--seed",    "--size",   "--camera", "--orbit",  "--opacity",
        "--background", "--methods", "--samples", "--layers", "--passes", "--repeat", "--warmup",
        "--output",     "-o",        "--heatmap", "--json",   "--quiet",  "--device", "--validate"}) {
    EXPECT_NE(result.out.find(option), std::string::npos) << option;
  }
}

} // namespace
} // namespace vitrail::tests
