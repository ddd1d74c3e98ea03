// --api opengl: pictures, reports, comparisons and benchmarks by OpenGL, what is refused, and machines without EGL.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "png_reader.h"
#include "vitrail.h"

namespace vitrail::tests {
namespace {

Words picture(const Words& more) {
  Words words = {"render", "--scene", "interlocked", "--size", "96x64", "-o", "a.png"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(OpenGl, APictureAndItsReport) {
  const TemporaryFolder folder;
  const ProcessResult result =
      vitrail(folder, picture({"--api", "opengl", "--validate", "--samples", "4", "--json", "a.json"}));
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(result.error, "");
  const Json report = readJson(folder.file("a.json"));
  EXPECT_TRUE(report.at("api").get<std::string>().starts_with("OpenGL 4.")) << report.at("api");
  EXPECT_EQ(report.at("method"), "linked-list");
  EXPECT_EQ(report.at("samples"), 4);
  EXPECT_EQ(report.at("msaa_resolve"), "per-pixel");
  EXPECT_EQ(report.at("exact"), true);
  EXPECT_GT(report.at("memory").at("nodes_bytes"), 0);
  EXPECT_GE(report.at("memory").at("peak_bytes"), report.at("memory").at("total_bytes"));
  for (const char* pass : {"opaque", "clear", "collect", "resolve", "statistics", "encode"}) {
    EXPECT_GE(report.at("passes_ms").at(pass).get<double>(), 0.0) << pass;
  }
  // It is the picture of Vulkan.
  ASSERT_EQ(vitrail(folder, {"render", "--scene", "interlocked", "--size", "96x64", "--samples", "4", "--method",
                             "linked-list", "-o", "b.png"})
                .exitCode,
            0);
  const ReadPng a = readPng(folder.file("a.png"));
  const ReadPng b = readPng(folder.file("b.png"));
  std::size_t beyond = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) beyond += std::abs(int{a.rgba[i]} - b.rgba[i]) > 1 ? 1U : 0U;
  EXPECT_LE(beyond, a.rgba.size() / 500);
}

TEST(OpenGl, EveryOptionOfRenderThatItHas) {
  for (const Words& options :
       {Words{"--method", "unsorted"}, Words{"--method", "sorted"}, Words{"--method", "depth-peeling", "--layers", "2"},
        Words{"--resolve", "fragment"}, Words{"--list-build", "compute"}, Words{"--nodes", "compact"},
        Words{"--memory-budget", "1"}, Words{"--bits", "16"}}) {
    SCOPED_TRACE(options[0] + " " + options[1]);
    const TemporaryFolder folder;
    Words words = picture({"--api", "opengl", "--validate"});
    words.insert(words.end(), options.begin(), options.end());
    const ProcessResult result = vitrail(folder, words);
    EXPECT_EQ(result.exitCode, 0) << result.error;
    EXPECT_EQ(result.error, "");
    EXPECT_EQ(folder.names(), Words{"a.png"});
  }
}

TEST(OpenGl, ATurn) {
  const TemporaryFolder folder;
  const ProcessResult result = vitrail(folder, {"render", "--scene", "interlocked", "--size", "48x32", "--turntable",
                                                "3", "--api", "opengl", "-o", "t_%d.png"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(folder.names().size(), 3U);
}

TEST(OpenGl, WhatItLacksIsRefused) {
  for (const std::string& tool : kTools) {
    expectRefusal(tool, picture({"--api", "metal"}), 2, "vulkan and opengl");
    expectRefusal(tool, picture({"--api", "opengl", "--method", "weighted"}), 2, "linked-list");
    expectRefusal(tool, picture({"--api", "opengl", "--device", "cpu"}), 2, "--api opengl");
    expectRefusal(tool, picture({"--api", "opengl", "--method", "depth-peeling", "--samples", "4"}), 2, "--samples");
  }
  expectRefusal(kTool, picture({"--api", "opengl", "--device", "abacus"}), 1, "abacus");
  expectRefusal(kTool, picture({"--api", "opengl", "--device", "99"}), 1, "99");
  expectRefusal(kTool, {"bench", "--scene", "planes", "--api", "vulkan,metal"}, 2, "opengl");
}

TEST(OpenGl, InfoListsItsDevices) {
  const ProcessResult info = vitrail({"info"});
  ASSERT_EQ(info.exitCode, 0) << info.error;
  const std::size_t heading = info.out.find("\nOpenGL devices\n");
  ASSERT_NE(heading, std::string::npos) << info.out;
  EXPECT_NE(info.out.find("--api opengl", heading), std::string::npos) << info.out;
}

TEST(OpenGl, MachinesWithoutADeviceAreToldSo) {
  const TemporaryFolder folder;
  const ProcessOptions bare{
      .folder = folder.path(), .environment = {"__EGL_VENDOR_LIBRARY_FILENAMES=/none.json"}, .running = {}};
  const ProcessResult result = vitrail(picture({"--api", "opengl"}), bare);
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_EQ(std::ranges::count(result.error, '\n'), 1) << result.error;
  EXPECT_NE(result.error.find("install"), std::string::npos) << result.error;
  EXPECT_TRUE(folder.names().empty());
  const ProcessResult info = vitrail({"info"}, bare);
  EXPECT_EQ(info.exitCode, 0) << info.error;
}

TEST(OpenGl, ComparedBesideVulkan) {
  const TemporaryFolder folder;
  const ProcessResult result =
      vitrail(folder, {"compare", "--scene", "interlocked", "--size", "96x64", "--methods", "linked-list,weighted",
                       "--api", "vulkan,opengl", "--repeat", "1", "--validate", "-o", "out"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const Json report = readJson(folder.file("out/report.json"));
  std::vector<std::string> drawn;
  for (const Json& method : report.at("methods")) {
    drawn.push_back(method.at("api").get<std::string>() + " " + method.at("method").get<std::string>());
    if (method.at("method") == "linked-list") {
      EXPECT_LE(method.at("metrics").at("worst").at("difference"), 1) << method;
    }
  }
  EXPECT_EQ(drawn, (Words{"vulkan unsorted", "vulkan linked-list", "vulkan weighted", "opengl unsorted",
                          "opengl linked-list"}));
  EXPECT_EQ(report.at("refused").size(), 1U); // weighted, which was named
  EXPECT_NE(result.out.find("linked-list, OpenGL"), std::string::npos) << result.out;
  EXPECT_EQ(readPng(folder.file("out/linked-list-opengl.png")).width, 96U);
  EXPECT_EQ(readPng(folder.file("out/linked-list.png")).width, 96U);
}

TEST(OpenGl, MeasuredBesideVulkan) {
  const TemporaryFolder folder;
  const ProcessResult result =
      vitrail(folder, {"bench", "--scene", "planes", "--count", "3", "--size", "64x48", "--api", "vulkan,opengl",
                       "--methods", "linked-list", "--repeat", "2", "--json", "b.json", "--csv", "b.csv"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const Json report = readJson(folder.file("b.json"));
  EXPECT_NE(report.at("api").get<std::string>().find("OpenGL"), std::string::npos);
  const Json& measured = report.at("scenes").at(0).at("measurements");
  ASSERT_EQ(measured.size(), 4U);
  for (const std::size_t i : {2U, 3U}) EXPECT_EQ(measured.at(i).at("api"), "opengl");
  // Each API has a baseline of its own.
  EXPECT_EQ(measured.at(0).at("cost_ratio"), 1.0);
  EXPECT_EQ(measured.at(2).at("cost_ratio"), 1.0);
  EXPECT_EQ(measured.at(3).at("fragments"), measured.at(1).at("fragments"));
  EXPECT_NE(readText(folder.file("b.csv")).find(",approximate_pixels,api\n"), std::string::npos);
  // Without Vulkan at all.
  const ProcessResult alone = vitrail({"bench", "--scene", "planes", "--count", "3", "--size", "64x48", "--api",
                                       "opengl", "--methods", "linked-list", "--repeat", "1"},
                                      {.folder = folder.path(),
                                       .environment = {"VK_DRIVER_FILES=/none.json", "VK_ICD_FILENAMES=/none.json"},
                                       .running = {}});
  EXPECT_EQ(alone.exitCode, 0) << alone.error;
}

} // namespace
} // namespace vitrail::tests
