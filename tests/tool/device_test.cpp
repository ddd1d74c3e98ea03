// Which device draws: the default, the names, what falls back to Vulkan and what is refused, and machines without it.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "png_reader.h"
#include "vitrail.h"

namespace vitrail::tests {
namespace {

const std::vector<std::string> kNoVulkan{"VK_ICD_FILENAMES=/none.json", "VK_DRIVER_FILES=/none.json"};

bool hasGpu() {
  static const bool has = vitrail({"info"}).out.find("GPU)") != std::string::npos;
  return has;
}

Words small(const Words& more) {
  Words words = {"render", "--scene", "interlocked", "--size", "48x32", "-o", "a.png", "--json", "a.json"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// The report of a small picture.
Json reportOf(const Words& more, const std::vector<std::string>& environment = {}) {
  const TemporaryFolder folder;
  const ProcessResult result =
      vitrail(small(more), {.folder = folder.path(), .environment = environment, .running = {}});
  EXPECT_EQ(result.exitCode, 0) << result.error;
  return result.exitCode == 0 ? readJson(folder.file("a.json")) : Json::object();
}

TEST(Device, TheProcessorIsListedFirstWhereThereIsNoGpu) {
  const ProcessResult info = vitrail({"info"});
  ASSERT_EQ(info.exitCode, 0) << info.error;
  const std::size_t cpu = info.out.find("\n  cpu ");
  const std::size_t vulkan = info.out.find("\n  0 ");
  ASSERT_NE(cpu, std::string::npos) << info.out;
  ASSERT_NE(vulkan, std::string::npos) << info.out;
  EXPECT_EQ(cpu < vulkan, !hasGpu()) << info.out;
}

TEST(Device, TheProcessorIsTheDefaultWhereThereIsNoGpu) {
  if (hasGpu()) GTEST_SKIP() << "there is a GPU";
  const Json report = reportOf({});
  EXPECT_EQ(report.at("api"), "CPU");
  EXPECT_EQ(report.at("method"), "cpu");
}

TEST(Device, TheReportOfTheProcessor) {
  for (const char* name : {"cpu", "CPU"}) {
    const Json report = reportOf({"--device", name});
    EXPECT_NE(vitrail({"info"}).out.find(report.at("device").get<std::string>()), std::string::npos);
    EXPECT_EQ(report.at("api"), "CPU");
    EXPECT_EQ(report.at("method"), "cpu");
    EXPECT_EQ(report.at("exact"), true);
    EXPECT_LE(report.at("error_bound_255"), 1.0);
    EXPECT_EQ(report.at("tiles"), 1);
    for (const char* none : {"nodes", "resolve", "list_build", "msaa_resolve"}) {
      EXPECT_EQ(report.at(none), nullptr) << none;
    }
    EXPECT_GT(report.at("fragments").at("stored"), 0);
    EXPECT_EQ(report.at("fragments").at("missing"), 0);
    EXPECT_GT(report.at("layers").at("max"), 1);
    EXPECT_GE(report.at("layers").at("mean"), 1.0);
    EXPECT_GE(report.at("memory").at("nodes_bytes"), 65536);
    EXPECT_GT(report.at("memory").at("peak_bytes"), 1 << 20);
    for (const char* pass : {"vertices", "draw"}) {
      EXPECT_GE(report.at("passes_ms").at(pass).get<double>(), 0.0) << pass;
    }
    // One colour is drawn behind the rest, and all of it encoded, as it is drawn.
    for (const char* none : {"background", "encode"}) EXPECT_FALSE(report.at("passes_ms").contains(none)) << none;
    EXPECT_GT(report.at("frame_ms"), 0.0);
  }
}

// The dynamic linker tells which libraries it opens.
bool loadsVulkan(const Words& more) {
  const TemporaryFolder folder;
  const ProcessResult result = vitrail(
      small(more), {.folder = folder.path(), .environment = {"LD_DEBUG=files", "LD_DEBUG_OUTPUT=ld"}, .running = {}});
  EXPECT_EQ(result.exitCode, 0) << result.error;
  for (const std::string& name : folder.names()) {
    if (name.starts_with("ld.") && readText(folder.path() / name).find("libvulkan") != std::string::npos) return true;
  }
  return false;
}

TEST(Device, VulkanIsLoadedOnlyWhereItIsNeeded) {
  EXPECT_FALSE(loadsVulkan({"--device", "cpu"}));
  EXPECT_FALSE(loadsVulkan({"--method", "cpu"}));
  EXPECT_TRUE(loadsVulkan({"--method", "sorted"}));
  if (!std::filesystem::exists("/dev/dri") && !hasGpu()) {
    EXPECT_FALSE(loadsVulkan({}));
  }
}

const std::vector<Words> kVulkanOptions{
    {"--method", "sorted"},      {"--method", "linked-list"}, {"--nodes", "standard"}, {"--resolve", "fragment"},
    {"--list-build", "compute"}, {"--layers", "40"},          {"--validate"}};

TEST(Device, WhatNeedsVulkanIsDrawnThere) {
  for (const Words& options : kVulkanOptions) {
    SCOPED_TRACE(options.front());
    const Json report = reportOf(options);
    EXPECT_EQ(report.at("api"), "Vulkan 1.3");
    EXPECT_EQ(report.at("method"), options.front() == "--method" ? options.back() : "linked-list");
  }
}

TEST(Device, WhatNeedsVulkanIsRefusedOnTheProcessor) {
  for (const Words& options : kVulkanOptions) {
    Words words = small(options);
    words.insert(words.end(), {"--device", "cpu"});
    for (const std::string& tool : kTools) {
      expectRefusal(tool, words, 2, options.front());
      expectRefusal(tool, words, 2, "needs a Vulkan device, which cpu is not");
    }
  }
  expectRefusal(kTool, small({"--method", "cpu", "--nodes", "compact"}), 2, "cpu has no choice");
  expectRefusal(kTool, small({"--method", "cpu", "--validate"}), 2, "leave --validate out");
  expectRefusal(kTool, small({"--device", "cpu", "--passes", "3"}), 2, "needs a Vulkan device, which cpu is not");
  for (const char* api : {"vulkan", "opengl"}) {
    expectRefusal(kTool, small({"--method", "cpu", "--api", api}), 2, "the method cpu draws without an API");
    expectRefusal(kTool, small({"--device", "cpu", "--api", api}), 2, "the device cpu draws without an API");
  }
  expectRefusal(kTool, small({"--method", "cpu", "--device", "llvmpipe"}), 2, "draws on the processor");
}

TEST(Device, AMachineWithoutVulkanDraws) {
  const TemporaryFolder folder;
  const ProcessOptions options{.folder = folder.path(), .environment = kNoVulkan, .running = {}};
  const ProcessResult info = vitrail({"info"}, options);
  EXPECT_EQ(info.exitCode, 0) << info.error;
  EXPECT_NE(info.out.find("\n  cpu "), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("mesa-vulkan-drivers"), std::string::npos) << info.out;
  EXPECT_EQ(reportOf({}, kNoVulkan).at("api"), "CPU");

  const ProcessResult sorted = vitrail(small({"--method", "sorted"}), options);
  EXPECT_EQ(sorted.exitCode, 1);
  EXPECT_NE(sorted.error.find("mesa-vulkan-drivers"), std::string::npos) << sorted.error;
  EXPECT_EQ(folder.names(), Words{});
}

TEST(Device, AMachineWithoutVulkanComparesAndMeasuresTheProcessor) {
  const TemporaryFolder folder;
  const ProcessOptions options{.folder = folder.path(), .environment = kNoVulkan, .running = {}};
  const Words scene = {"--scene", "planes", "--count", "5", "--size", "48x32", "--repeat", "1", "--json", "a.json"};
  for (const char* command : {"compare", "bench"}) {
    SCOPED_TRACE(command);
    Words words{command};
    words.insert(words.end(), scene.begin(), scene.end());
    const ProcessResult result = vitrail(words, options);
    ASSERT_EQ(result.exitCode, 0) << result.error;
    EXPECT_NE(result.out.find("mesa-vulkan-drivers"), std::string::npos) << result.out; // why the others are left out
    const Json json = readJson(folder.file("a.json"));
    EXPECT_EQ(json.at("api"), "CPU");
    EXPECT_EQ(json.at("cpu"), true);
    EXPECT_EQ(json.at("device"), json.at("processor"));
    const Json& measured =
        command == std::string("compare") ? json.at("methods") : json.at("scenes")[0].at("measurements");
    ASSERT_EQ(measured.size(), 1U);
    EXPECT_EQ(measured[0].at("method"), "cpu");
    EXPECT_EQ(measured[0].at("exact"), true);
    EXPECT_EQ(measured[0].at("cost_ratio"), nullptr); // there is no baseline
    EXPECT_GT(measured[0].at("cost_ms").at("median"), 0.0);
    if (command == std::string("compare")) {
      EXPECT_EQ(json.at("layers_max"), 5);
      EXPECT_EQ(measured[0].at("metrics").at("psnr_db"), nullptr); // equal
    }
  }
}

TEST(Device, TheProcessorIsComparedWithVulkanMethods) {
  const TemporaryFolder folder;
  const ProcessResult result = vitrail(folder, {"compare", "--scene", "interlocked", "--size", "96x64", "--methods",
                                                "cpu,linked-list", "--repeat", "1", "--json", "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_NE(result.out.find("The method cpu is drawn by "), std::string::npos) << result.out;
  const Json json = readJson(folder.file("a.json"));
  EXPECT_EQ(json.at("exact_picture").at("method"), "linked-list");
  ASSERT_EQ(json.at("methods").size(), 3U); // unsorted too
  const Json& cpu = json.at("methods")[1];
  EXPECT_EQ(cpu.at("method"), "cpu");
  EXPECT_LE(cpu.at("metrics").at("worst").at("difference"), 1);
  EXPECT_GT(cpu.at("cost_ratio"), 0.0);
}

TEST(Device, AMethodOfTheProcessorAloneNeedsNoVulkan) {
  const TemporaryFolder folder;
  const ProcessResult result = vitrail(folder, {"bench", "--scene", "planes", "--size", "48x32", "--repeat", "1",
                                                "--methods", "cpu", "--json", "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(readJson(folder.file("a.json")).at("api"), "CPU");
  EXPECT_NE(result.out.find("Times are by the clock"), std::string::npos) << result.out;
}

TEST(Device, EverySampleCountOnTheProcessor) {
  std::uint64_t before = 0;
  for (const char* samples : {"1", "2", "4", "8"}) {
    const Json report = reportOf({"--device", "cpu", "--samples", samples});
    EXPECT_EQ(std::to_string(report.at("samples").get<int>()), samples);
    EXPECT_EQ(report.at("exact"), true);
    const std::uint64_t stored = report.at("fragments").at("stored");
    EXPECT_GE(stored, before) << "edges have more fragments";
    before = stored;
  }
}

TEST(Device, EveryMemoryBudgetGivesTheSamePictureOnTheProcessor) {
  const TemporaryFolder folder;
  Words words = {"render", "--scene", "smoke", "--size", "256x192", "--device", "cpu", "-o", "whole.png"};
  ASSERT_EQ(vitrail(folder, words).exitCode, 0);
  words.back() = "budget.png";
  words.insert(words.end(), {"--memory-budget", "1"});
  ASSERT_EQ(vitrail(folder, words).exitCode, 0);
  EXPECT_TRUE(readText(folder.path() / "whole.png") == readText(folder.path() / "budget.png"));
}

TEST(Device, EveryEncodingOfTheProcessor) {
  const TemporaryFolder folder;
  for (const Words& output : {Words{"-o", "a.png"}, Words{"-o", "b.png", "--bits", "16"}, Words{"-o", "c.exr"},
                              Words{"-o", "d.exr", "--bits", "32"}}) {
    for (const char* background : {"#203040", "sky", "transparent"}) {
      Words words = {"render", "--scene", "flames", "--size", "48x32", "--device", "cpu", "--background", background};
      words.insert(words.end(), output.begin(), output.end());
      const ProcessResult result = vitrail(folder, words);
      EXPECT_EQ(result.exitCode, 0) << result.error;
      EXPECT_EQ(result.error, "") << output[1] << " " << background; // it is not empty
    }
  }
  EXPECT_EQ(folder.names(), (Words{"a.png", "b.png", "c.exr", "d.exr"}));
}

TEST(Device, LongSidesOnTheProcessor) {
  const TemporaryFolder folder;
  const auto render = [&](const char* size) {
    return Words{"render", "--scene", "planes", "--count", "2", "--device", "cpu", "--size", size, "-o", "a.png"};
  };
  EXPECT_EQ(vitrail(folder, render("32768x1")).exitCode, 0);
  EXPECT_EQ(readPng(folder.file("a.png")).width, 32768U);
  EXPECT_EQ(vitrail(folder, render("1x32768")).exitCode, 0);
  expectRefusal(kTool, render("32769x1"), 1, "at most 32768x32768");
}

// Larger than what is drawn at once: the parts fit together.
TEST(Device, ALargePictureIsDrawnInBands) {
  const TemporaryFolder folder;
  const ProcessResult result =
      vitrail(folder, {"render", "--scene", "planes", "--count", "1", "--device", "cpu", "--size", "8192x2560",
                       "--bits", "16", "-o", "a.png", "--json", "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const Json report = readJson(folder.file("a.json"));
  EXPECT_EQ(report.at("tiles"), 2);
  EXPECT_TRUE(report.at("passes_ms").contains("encode")) << report;
  EXPECT_EQ(readPng(folder.file("a.png")).height, 2560U);
}

TEST(Device, PointsOfTheProcessorAreAsLargeAsMayBe) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("point.ply"))
      << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  const auto draw = [&](const Words& what) {
    Words words = {"render", "--device", "cpu", "--size", "48x32", "-o", "a.png", "--point-size", "5000"};
    words.insert(words.end(), what.begin(), what.end());
    return vitrail(words, {.folder = folder.path(), .environment = {}, .running = {}});
  };
  const ProcessResult points = draw({"point.ply"});
  EXPECT_EQ(points.exitCode, 0) << points.error;
  EXPECT_NE(points.error.find("points of 5000 pixels are drawn with 2048"), std::string::npos) << points.error;
  const ProcessResult others = draw({"--scene", "interlocked"});
  EXPECT_EQ(others.exitCode, 0) << others.error;
  EXPECT_EQ(others.error.find("points"), std::string::npos) << others.error;
}

TEST(Device, MemoryThatIsNotThereIsOneLine) {
  const TemporaryFolder folder;
  const std::string command =
      "ulimit -v 400000; exec '" + kTool + "' render --scene planes --device cpu --size 30000x30000 -o a.png";
  const ProcessResult result =
      run({"/bin/sh", "-c", command}, {.folder = folder.path(), .environment = {}, .running = {}});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
  EXPECT_NE(result.error.find("out of memory"), std::string::npos) << result.error;
  EXPECT_EQ(folder.names(), Words{});
}

// Fragments are not kept for the whole picture: 10^8 of them, whether they hide each other or not. For 10^10 see
// docs/testing.md.
TEST(Device, DeepPicturesNeedLittleMemory) {
  const TemporaryFolder folder;
  for (const char* alpha : {"0.0002", "0.5"}) {
    SCOPED_TRACE(alpha);
    const ProcessResult made = run({"/usr/bin/env", "python3", VITRAIL_TEST_CORPUS "/../tool/make_large.py", "panes",
                                    "1000", alpha, folder.file("panes.gltf")},
                                   {.folder = folder.path(), .environment = {}, .running = {}});
    ASSERT_EQ(made.exitCode, 0) << made.error;
    const ProcessResult result = vitrail(folder, {"render", "panes.gltf", "--eye", "0,0,1", "--fov", "50", "--size",
                                                  "320x320", "--device", "cpu", "-o", "a.png", "--json", "a.json"});
    ASSERT_EQ(result.exitCode, 0) << result.error;
    const Json report = readJson(folder.file("a.json"));
    EXPECT_EQ(report.at("fragments").at("requested"), 1000 * 320 * 320);
    EXPECT_EQ(report.at("fragments").at("missing"), 0);
    EXPECT_EQ(report.at("layers").at("max"), 1000);
    EXPECT_EQ(report.at("exact"), true);
    EXPECT_LT(report.at("memory").at("peak_bytes"), std::uint64_t{256} << 20U); // 12 bytes a fragment were 1.2 GB
  }
}

// Many triangles of less than a pixel. For 2 * 10^7 see docs/testing.md.
TEST(Device, ManyTrianglesAreDrawn) {
  const TemporaryFolder folder;
  const ProcessResult made = run({"/usr/bin/env", "python3", VITRAIL_TEST_CORPUS "/../tool/make_large.py", "triangles",
                                  "200000", folder.file("a.stl")},
                                 {.folder = folder.path(), .environment = {}, .running = {}});
  ASSERT_EQ(made.exitCode, 0) << made.error;
  const ProcessResult result = vitrail(folder, {"render", "a.stl", "--opacity", "0.5", "--size", "64x64", "--device",
                                                "cpu", "-o", "a.png", "--json", "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(readJson(folder.file("a.json")).at("exact"), true);
}

// From the call to the file; the machine may be busy, so the best of several counts.
TEST(Device, ASmallPictureIsThereAtOnce) {
  const TemporaryFolder folder;
  double best = 1e9;
  for (int i = 0; i < 5; ++i) {
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(vitrail(folder, small({"--device", "cpu"})).exitCode, 0);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  EXPECT_LT(best, 0.2);
}

} // namespace
} // namespace vitrail::tests
