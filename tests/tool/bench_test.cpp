// `vitrail bench` and the method insertion as a user meets them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "png_reader.h"
#include "vitrail.h"

namespace vitrail::tests {
namespace {

// A spread of at least one time above 0.
void expectTimes(const Json& spread) {
  EXPECT_GT(spread.at("median"), 0.0);
  EXPECT_LE(spread.at("min"), spread.at("lower_quartile"));
  EXPECT_LE(spread.at("lower_quartile"), spread.at("median"));
  EXPECT_LE(spread.at("median"), spread.at("upper_quartile"));
  EXPECT_LE(spread.at("upper_quartile"), spread.at("max"));
}

void expectMeasurement(const Json& measured) {
  SCOPED_TRACE(measured.dump());
  for (const auto& [pass, spread] : measured.at("passes_ms").items()) expectTimes(spread);
  expectTimes(measured.at("cost_ms"));
  expectTimes(measured.at("frame_ms"));
  EXPECT_GT(measured.at("frame_ms").at("median"), measured.at("cost_ms").at("median"));
  for (const char* name : {"cost_ratio", "frame_ratio", "fragments_per_second"}) {
    const double value = measured.at(name).get<double>(); // null would throw
    EXPECT_TRUE(std::isfinite(value) && value > 0.0) << name;
  }
  const bool baseline = measured.at("method") == "unsorted";
  const bool lists = measured.at("method") == "linked-list";
  EXPECT_EQ(measured.at("exact"), lists); // insertion stores 8 bits of alpha
  if (baseline) {
    EXPECT_DOUBLE_EQ(measured.at("cost_ratio"), 1.0);
    for (const char* name :
         {"nodes", "resolve", "list_build", "fragments", "layers", "floor_bytes", "floor_ms", "bandwidth_share"}) {
      EXPECT_TRUE(measured.at(name).is_null()) << name;
    }
    return;
  }
  EXPECT_EQ(measured.at("nodes"), lists ? Json("hdr") : Json(nullptr));
  EXPECT_GT(measured.at("layers").at("max"), 1);
  EXPECT_EQ(measured.at("tiles"), 1);
  const double fragments = measured.at("fragments").at("requested");
  EXPECT_EQ(measured.at("fragments").at("stored"), fragments);
  EXPECT_EQ(measured.at("fragments").at("missing"), 0);
  // At least a node in and out for every fragment, and no more than the heads and colours of all pixels beside them.
  const double nodeBytes = lists ? 16.0 : 12.0;
  EXPECT_GT(measured.at("floor_bytes"), 2.0 * nodeBytes * fragments);
  EXPECT_LE(measured.at("floor_bytes"), 2.0 * nodeBytes * fragments + 32.0 * 96 * 64);
  EXPECT_GT(measured.at("floor_ms"), 0.0);
  EXPECT_NEAR(measured.at("bandwidth_share").get<double>(),
              measured.at("floor_ms").get<double>() / measured.at("cost_ms").at("median").get<double>(), 1e-9);
}

TEST(Bench, MeasuresAndReports) {
  const TemporaryFolder folder;
  const ProcessResult result =
      vitrail(folder, {"bench", "--scene", "interlocked,planes", "--count", "5,3", "--size", "96x64", "--repeat", "2",
                       "--warmup", "1", "--methods", "linked-list,insertion", "--json", "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(result.error, ""); // no progress in a pipe
  EXPECT_EQ(folder.names(), Words{"a.json"});
  EXPECT_NE(result.out.find("planes --count 3"), std::string::npos) << result.out;

  const Json json = readJson(folder.file("a.json"));
  for (const char* name : {"device", "driver", "api"}) EXPECT_FALSE(json.at(name).get<std::string>().empty()) << name;
  EXPECT_TRUE(json.at("cpu").is_boolean());
  EXPECT_EQ(json.at("width"), 96);
  EXPECT_EQ(json.at("height"), 64);
  EXPECT_EQ(json.at("repeats"), 2);
  EXPECT_EQ(json.at("warmups"), 1);
  EXPECT_GT(json.at("bandwidth_gb_s"), 0.1);
  ASSERT_EQ(json.at("scenes").size(), 2U);
  EXPECT_EQ(json.at("scenes")[0].at("scene"), "interlocked");
  EXPECT_EQ(json.at("scenes")[1].at("count"), 3);
  EXPECT_GT(json.at("scenes")[1].at("triangles"), 0);
  for (const Json& scene : json.at("scenes")) {
    EXPECT_TRUE(scene.at("skipped").empty()) << scene.dump();
    Words methods;
    for (const Json& measured : scene.at("measurements")) {
      methods.push_back(measured.at("method"));
      expectMeasurement(measured);
    }
    EXPECT_EQ(methods, (Words{"unsorted", "linked-list", "insertion"}));
  }
  // Fragments per pixel and layer are the same whoever stores them.
  const Json& planes = json.at("scenes")[1].at("measurements");
  EXPECT_EQ(planes[1].at("fragments"), planes[2].at("fragments"));
  EXPECT_EQ(planes[1].at("layers").at("max"), planes[2].at("layers").at("max"));
}

// What a device does not offer is said, and does not end the run. Mesa's CPU driver has no 8 samples.
TEST(Bench, EverySettingIsMeasuredOrSkippedWithAReason) {
  const TemporaryFolder folder;
  const ProcessResult result =
      vitrail(folder, {"bench",    "--scene",   "planes",    "--count",      "2",       "--size",           "32x32",
                       "--repeat", "1",         "--methods", "linked-list",  "--nodes", "compact,standard", "--samples",
                       "1,8",      "--resolve", "fragment",  "--list-build", "compute", "--json",           "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const Json scene = readJson(folder.file("a.json")).at("scenes")[0];
  // unsorted, compact and standard at 1 sample and at 8.
  EXPECT_EQ(scene.at("measurements").size() + scene.at("skipped").size(), 6U) << scene.dump(1);
  ASSERT_GE(scene.at("measurements").size(), 3U) << scene.dump(1);
  EXPECT_EQ(scene.at("measurements")[1].at("nodes"), "compact");
  EXPECT_EQ(scene.at("measurements")[1].at("resolve"), "fragment");
  EXPECT_EQ(scene.at("measurements")[1].at("list_build"), "compute");
  EXPECT_EQ(scene.at("measurements")[2].at("nodes"), "standard");
  for (const Json& skipped : scene.at("skipped")) {
    EXPECT_EQ(skipped.at("samples"), 8) << skipped.dump();
    const bool hasNodes = skipped.at("method") == "linked-list";
    EXPECT_EQ(skipped.at("nodes").is_null(), !hasNodes) << skipped.dump();
    const std::string nodes =
        hasNodes ? ", " + skipped.at("nodes").get<std::string>() + ", fragment, list build compute" : "";
    EXPECT_EQ(skipped.at("setting"), skipped.at("method").get<std::string>() + nodes) << skipped.dump();
    EXPECT_NE(skipped.at("reason").get<std::string>().find("samples"), std::string::npos) << skipped.dump();
    EXPECT_NE(result.out.find(skipped.at("reason")), std::string::npos) << result.out;
  }
}

// All methods, as the program names them where it is given another name.
Words allMethods(const TemporaryFolder& folder) {
  const std::string error = vitrail(folder, {"bench", "--methods", "magic"}).error;
  const std::string before = "there are ";
  const std::size_t begin = error.find(before) + before.size();
  const std::string list = error.substr(begin, error.find_first_of("(\n", begin) - begin);
  Words names;
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t end = list.find_first_of(", ", at);
    names.push_back(list.substr(at, end - at));
    at = std::max(end, list.find_first_not_of(", ", end));
  }
  return names;
}

// Where no methods are named all are measured, or skipped with the reason.
TEST(Bench, MeasuresEveryMethod) {
  const TemporaryFolder folder;
  const Words methods = allMethods(folder);
  ASSERT_GE(methods.size(), 5U);
  ASSERT_EQ(methods.front(), "linked-list");
  const ProcessResult result = vitrail(folder, {"bench", "--scene", "planes", "--count", "2", "--size", "16x16",
                                                "--repeat", "1", "--samples", "1,4", "--json", "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const Json scene = readJson(folder.file("a.json")).at("scenes")[0];
  for (const std::string& method : methods) {
    for (const int samples : {1, 4}) {
      int measured = 0;
      int skipped = 0;
      for (const Json& each : scene.at("measurements"))
        measured += each.at("method") == method && each.at("samples") == samples;
      for (const Json& each : scene.at("skipped")) {
        const bool isIt = each.at("method") == method && each.at("samples") == samples;
        skipped += isIt;
        if (isIt) {
          EXPECT_NE(result.out.find(each.at("reason")), std::string::npos) << result.out;
        }
      }
      EXPECT_EQ(measured + skipped, 1) << method << " at " << samples;
      if (samples == 1 && method == "linked-list") {
        EXPECT_EQ(measured, 1);
      }
    }
  }
}

std::vector<Words> readCsv(const std::string& path) {
  std::ifstream file(path);
  std::vector<Words> rows;
  for (std::string line; std::getline(file, line);) {
    Words cells(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') {
        quoted = !quoted;
      } else if (c == ',' && !quoted) {
        cells.emplace_back();
      } else {
        cells.back() += c;
      }
    }
    rows.push_back(cells);
  }
  return rows;
}

TEST(Bench, SweepsGoToTheTableAndToAllFiles) {
  const TemporaryFolder folder;
  const ProcessResult result =
      vitrail(folder, {"bench", "--sweep", "layers,triangles,samples", "--methods", "linked-list", "--size", "32x24",
                       "--repeat", "1", "--count", "1", "--json", "a.json", "--csv", "a.csv", "-o", "out"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(folder.names(), (Words{"a.csv", "a.json", "out"}));
  const Json json = readJson(folder.file("a.json"));
  EXPECT_EQ(json, readJson(folder.file("out/report.json")));
  EXPECT_EQ(json.at("width"), 32);

  double before = 0.0;
  std::string sweep;
  std::size_t measurements = 0;
  for (const Json& scene : json.at("scenes")) {
    SCOPED_TRACE(scene.dump());
    if (scene.at("sweep") != sweep) before = 0.0;
    sweep = scene.at("sweep");
    EXPECT_GT(scene.at("step"), before); // every step is larger than the one before it
    before = scene.at("step");
    EXPECT_EQ(scene.at("height"), 24);
    EXPECT_EQ(scene.at("measurements").size() + scene.at("skipped").size(), 2U);
    measurements += scene.at("measurements").size();
    for (const Json& measured : scene.at("measurements")) {
      EXPECT_GT(measured.at("cost_ratio"), 0.0);
      if (measured.at("method") != "linked-list") continue;
      EXPECT_GT(measured.at("memory_bytes"), 0);
      if (sweep == "layers") {
        EXPECT_EQ(measured.at("layers").at("max"), scene.at("step"));
      }
      if (sweep == "samples") {
        EXPECT_EQ(measured.at("samples"), scene.at("step"));
      }
    }
    if (sweep == "triangles") {
      EXPECT_EQ(scene.at("triangles"), scene.at("step"));
    }
    EXPECT_NE(result.out.find(scene.at("label").get<std::string>()), std::string::npos) << result.out;
  }
  EXPECT_EQ(sweep, "samples");

  // Splitting triangles leaves fragments where they are.
  std::vector<double> fragments;
  for (const Json& scene : json.at("scenes")) {
    if (scene.at("sweep") == "triangles") {
      fragments.push_back(scene.at("measurements")[1].at("fragments").at("requested"));
    }
  }
  ASSERT_GE(fragments.size(), 3U);
  EXPECT_NEAR(fragments.back(), fragments.front(), 0.01 * fragments.front());

  const std::vector<Words> rows = readCsv(folder.file("a.csv"));
  EXPECT_EQ(rows, readCsv(folder.file("out/report.csv")));
  EXPECT_EQ(rows.size(), 1 + measurements);
  for (const Words& row : rows) EXPECT_EQ(row.size(), rows[0].size());

  ASSERT_GE(json.at("recommendation").size(), 6U); // exact, and approximate, of each sweep
  EXPECT_NE(json.at("recommendation")[0].at("text").get<std::string>().find("linked-list, hdr"), std::string::npos);
  EXPECT_NE(result.out.find("out/index.html"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder.file("out/index.html")));
}

TEST(Bench, ProgressOfASweepIsShownOnATerminalAlone) {
  const TemporaryFolder folder;
  const std::string command = "bench --sweep samples --count 1 --size 16x16 --repeat 1 --methods unsorted ";
  const std::string shown = onTerminal(folder, command);
  EXPECT_NE(shown.find("samples: step 2 of 4, unsorted, 2 samples"), std::string::npos) << shown;
  EXPECT_NE(shown.find("samples: round 1 of 1"), std::string::npos) << shown; // of all steps
  EXPECT_EQ(onTerminal(folder, command + "--quiet"), "");
}

TEST(Bench, TheReportCanGoToStandardOutput) {
  const TemporaryFolder folder;
  const ProcessResult result = vitrail(folder, {"bench", "--scene", "planes", "--size", "16x16", "--repeat", "1",
                                                "--methods", "unsorted", "--json", "/dev/stdout"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_EQ(Json::parse(result.out).at("scenes")[0].at("measurements").size(), 1U);
}

TEST(Bench, QuietPrintsNothing) {
  const TemporaryFolder folder;
  const ProcessResult result = vitrail(
      folder, {"bench", "--scene", "planes", "--size", "16x16", "--repeat", "1", "--methods", "unsorted", "--quiet"});
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_EQ(result.out + result.error, "");
}

TEST(Bench, TheHelpPageNamesEveryOption) {
  const std::string help = vitrail(TemporaryFolder(), {"bench", "--help"}).out;
  for (const char* option :
       {"MODEL",      "--scene",        "--count",      "--size",         "--opacity",      "--methods",
        "--nodes",    "--samples",      "--resolve",    "--layers",       "--passes",       "--repeat",
        "--warmup",   "--json",         "--csv",        "--sweep",        "--output",       "-o",
        "--quiet",    "--device",       "--list-build", "--msaa-resolve", "--stencil-mark", "--memory-budget",
        "--overflow", "--node-capacity"}) {
    EXPECT_NE(help.find(option), std::string::npos) << option;
  }
}

TEST(Bench, WrongUsageIsOneLineAndExitCode2) {
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"--methods", "linked-list,magic"}, "'magic' is not a method"},
      {{"--methods", ""}, "--methods"},
      {{"--nodes", "standard,"}, "'' is not a node format"},
      {{"--nodes", "tiny"}, "standard, compact or hdr"},
      {{"--samples", "1,3"}, "'3' is not 1, 2, 4 or 8"},
      {{"--samples", "x"}, "--samples"},
      {{"--resolve", "raster"}, "compute or fragment"},
      {{"--list-build", "late"}, "a list build: fragment or compute"},
      {{"--scene", "spheres,,planes"}, "--scene"},
      {{"--scene", "spheres,sheres"}, "sheres"},
      {{"--scene", "spheres", "--count", "0"}, "1 to 20000"},
      {{"--scene", "spheres,planes", "--count", "1,2,3"}, "--count has 3 numbers for 2 scenes"},
      {{"--count", "-1"}, "--count"},
      {{"a.glb", "--scene", "spheres"}, "exclude"},
      {{"a.glb", "--count", "3"}, "--count"},
      {{"--repeat", "0"}, "--repeat"},
      {{"--repeat", "1e3"}, "--repeat"},
      {{"--warmup", "0"}, "--warmup"},
      {{"--size", "100"}, "--size"},
      {{"--size", "0x10"}, "--size"},
      {{"--opacity", "0"}, "--opacity"},
      {{"--opacity", "nan"}, "--opacity"},
      {{"--heatmap", "a.png"}, "--heatmap"},
      {{"--sweep", "layer"}, "'layer' is not a sweep: layers, triangles, resolution, samples or cap"},
      {{"--sweep", ""}, "--sweep"},
      {{"--sweep", "layers,layers"}, "layers twice"},
      {{"--sweep", "layers", "--scene", "spheres"}, "leave MODEL, --scene and --count out"},
      {{"--sweep", "layers", "--count", "3"}, "leave MODEL, --scene and --count out"},
      {{"--sweep", "triangles", "--scene", "spheres,planes"}, "one scene"},
      {{"--sweep", "triangles", "--count", "1,2"}, "one scene"},
      {{"--sweep", "resolution", "--size", "32x32"}, "leave --size out"},
      {{"--sweep", "samples", "--samples", "4"}, "leave --samples out"},
      {{"--sweep", "layers", "--samples", "1,4"}, "one number of --samples"},
      {{"--csv", "a.json"}, "--json and --csv name one file"},
      {{"--layers", "0"}, "--layers"},
      {{"--layers", "8,16,x"}, "'x' is not a whole number from 1"},
      {{"--sweep", "cap", "--methods", "weighted"}, "weighted has no choice"},
      {{"--sweep", "cap,samples", "--layers", "8,16"}, "the steps of --sweep cap"},
      {{"--msaa-resolve", "per-frame"}, "'per-frame' is not a resolve of samples: per-pixel or per-sample"},
      {{"--msaa-resolve", "per-sample", "--methods", "weighted"}, "--msaa-resolve has no method that was named"},
      {{"--stencil-mark", "on,maybe"}, "'maybe' is not on or off"},
      {{"--stencil-mark", "off", "--methods", "loop"}, "--stencil-mark has no method that was named"},
      {{"--memory-budget", "64,0"}, "'0' is not a whole number from 1"},
      {{"--memory-budget", "64,999999999999"}, "999999999999 is too large: 4294967295 at the most"},
      {{"--memory-budget", "64", "--methods", "loop,a-buffer"}, "--memory-budget has no method that was named"},
      {{"--overflow", "ignore"}, "'ignore' is none of grow and approximate"},
      {{"--overflow", "approximate"}, "add --node-capacity N"},
      {{"--node-capacity", "100"}, "--node-capacity is of --overflow approximate"},
      {{"--overflow", "grow", "--node-capacity", "100"}, "--node-capacity is of --overflow approximate"},
      {{"--overflow", "approximate", "--node-capacity", "-4"}, "'-4' is not a whole number from 1"},
      {{"--overflow", "approximate", "--node-capacity", "4", "--memory-budget", "1"}, "leave --memory-budget out"},
      {{"--overflow", "approximate", "--node-capacity", "4", "--methods", "cpu"}, "--overflow has no method"},
      {{"--passes", "1.5"}, "--passes"},
      {{"--methods", "weighted", "--layers", "4"}, "weighted has no choice"},
      {{"--methods", "linked-list,loop", "--passes", "4"}, "linked-list has no choice"},
  };
  for (const auto& [arguments, reason] : cases) {
    Words words{"bench"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    words.insert(words.end(), {"--json", "a.json"});
    for (const std::string& tool : kTools) expectRefusal(tool, words, 2, reason);
  }
}

TEST(Bench, WhatCannotBeDoneIsOneLineAndExitCode1) {
  for (const std::string& tool : kTools) {
    expectRefusal(tool, {"bench", "no-such-file.glb", "--json", "a.json"}, 1, "no-such-file.glb");
    expectRefusal(tool, {"bench", "--json", "nowhere/a.json"}, 1, "nowhere");
    expectRefusal(tool, {"bench", "--csv", "nowhere/a.csv"}, 1, "nowhere");
    expectRefusal(tool, {"bench", "-o", "nowhere/out"}, 1, "nowhere");
  }
  expectRefusal(kTool, {"bench", "--device", "abacus", "--json", "a.json"}, 1, "abacus");
  const std::string opaque = VITRAIL_TEST_CORPUS "/good/triangle.gltf";
  for (const char* methods : {"linked-list", "unsorted", "weighted"}) { // whether or not one of them counts fragments
    expectRefusal(kTool,
                  {"bench", opaque, "--size", "16x16", "--repeat", "1", "--methods", methods, "--json", "a.json"}, 1,
                  "--opacity");
  }
}

// The device that there is not would be the next thing to be refused: nothing is measured before.
TEST(Bench, AFolderWhoseFilesCannotBeWrittenIsRefusedBeforeMeasuring) {
  for (const std::string name : {"report.json", "report.csv", "index.html"}) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "out" / name);
    expectRefusal(folder, kTool, {"bench", "-o", "out", "--device", "abacus"}, 1,
                  "cannot write out/" + name + ": it is a folder");
  }
}

// What -o writes cannot be another output too: said before anything is measured.
TEST(Bench, AnOutputThatTheFolderHasIsRefused) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "out");
  for (const std::string option : {"--json", "--csv"}) {
    for (const std::string name : {"report.json", "report.csv", "index.html"}) {
      expectRefusal(folder, kTool, {"bench", "-o", "out/", option, "./out/" + name}, 2,
                    "-o writes out/" + name + " itself: leave " + option + " out or name another file");
    }
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "out"));
}

// They are of the methods that have them, in every list of settings.
TEST(Bench, LayersAndPasses) {
  const TemporaryFolder folder;
  const ProcessResult result = vitrail(folder, {"bench", "--scene", "planes", "--count", "5", "--size", "16x16",
                                                "--repeat", "1", "--methods", "linked-list,depth-peeling,stochastic",
                                                "--samples", "1,4", "--layers", "2", "--passes", "3", "-o", "out"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  EXPECT_NE(result.out.find("\nOf the methods that have the option: --layers 2 --passes 3\n"), std::string::npos)
      << result.out;
  const Json scene = readJson(folder.file("out/report.json")).at("scenes")[0];
  const std::map<std::string, std::string> settings{{"unsorted", "unsorted"},
                                                    {"linked-list", "linked-list, hdr, 2 layers"},
                                                    {"depth-peeling", "depth-peeling, 2 layers"},
                                                    {"stochastic", "stochastic, 3 passes"}};
  std::size_t count = 0;
  for (const char* list : {"measurements", "skipped"}) {
    for (const Json& each : scene.at(list)) {
      const std::string setting = settings.at(each.at("method"));
      EXPECT_EQ(each.at("setting"), setting);
      EXPECT_EQ(each.at("max_layers"), setting.ends_with("layers") ? Json(2) : Json()) << setting;
      EXPECT_EQ(each.at("passes"), setting.ends_with("passes") ? Json(3) : Json()) << setting;
      ++count;
    }
  }
  EXPECT_EQ(count, 8U);
  EXPECT_EQ(scene.at("measurements")[1].at("exact"), false); // 2 of 5
}

// The measurements of linked-list in the first scene.
Json listsOf(const TemporaryFolder& folder, Words words) {
  words.insert(words.begin(), {"bench", "--scene", "spheres", "--count", "8", "--size", "64x48", "--repeat", "1"});
  words.insert(words.end(), {"--methods", "linked-list", "--json", "a.json"});
  const ProcessResult result = vitrail(folder, words);
  EXPECT_EQ(result.exitCode, 0) << result.error;
  Json lists = Json::array();
  const Json json = readJson(folder.file("a.json"));
  for (const Json& each : json.at("scenes")[0].at("measurements")) {
    if (each.at("method") == "linked-list") lists.push_back(each);
  }
  return lists;
}

TEST(Bench, SeveralLayersAreCompared) {
  const Json lists = listsOf(TemporaryFolder(), {"--layers", "1,2,64"});
  ASSERT_EQ(lists.size(), 3U);
  EXPECT_EQ(lists[0].at("setting"), "linked-list, hdr, 1 layer");
  EXPECT_EQ(lists[2].at("max_layers"), 64);
  EXPECT_GT(lists[0].at("approximate_pixels"), lists[1].at("approximate_pixels"));
  EXPECT_EQ(lists[0].at("exact"), false);
  EXPECT_EQ(lists[2].at("approximate_pixels"), 0);
  EXPECT_EQ(lists[2].at("exact"), true);
}

TEST(Bench, ASweepOverTheCap) {
  const TemporaryFolder folder;
  for (const bool own : {false, true}) {
    Words words{"bench", "--sweep", "cap", "--count", "8", "--size", "64x48", "--repeat", "1"};
    words.insert(words.end(), {"--methods", "linked-list,weighted", "--json", "a.json"});
    if (own) words.insert(words.end(), {"--layers", "4,1"});
    const ProcessResult result = vitrail(folder, words);
    ASSERT_EQ(result.exitCode, 0) << result.error;
    const Json scenes = readJson(folder.file("a.json")).at("scenes");
    std::vector<int> steps;
    for (const Json& scene : scenes) {
      EXPECT_EQ(scene.at("sweep"), "cap");
      steps.push_back(scene.at("step"));
      const Json& lists = scene.at("measurements")[1];
      EXPECT_EQ(lists.at("setting"), "linked-list, hdr"); // one line of the chart
      EXPECT_EQ(lists.at("max_layers"), scene.at("step"));
      EXPECT_TRUE(scene.at("measurements")[2].at("max_layers").is_null());
    }
    EXPECT_EQ(steps, own ? (std::vector<int>{1, 4}) : (std::vector<int>{8, 16, 32}));
    EXPECT_NE(result.out.find("\ncap: spheres --count 8, 64x48"), std::string::npos) << result.out;
    if (own) {
      EXPECT_EQ(scenes[0].at("measurements")[1].at("exact"), false);
    }
  }
}

// Where samples are blended, and whether empty pixels are skipped by the stencil: the device's work, the same
// fragments.
TEST(Bench, ResolvesOfSamplesAndTheStencilMark) {
  const Json lists = listsOf(TemporaryFolder(), {"--samples", "4", "--resolve", "fragment", "--msaa-resolve",
                                                 "per-pixel,per-sample", "--stencil-mark", "on,off"});
  ASSERT_EQ(lists.size(), 3U) << lists.dump(1);
  EXPECT_EQ(lists[0].at("msaa_resolve"), "per-pixel");
  EXPECT_TRUE(lists[0].at("stencil_mark").is_null()); // every pixel is written
  EXPECT_FALSE(lists[0].at("passes_ms").contains("box_filter"));
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_EQ(lists[i].at("msaa_resolve"), "per-sample");
    EXPECT_TRUE(lists[i].at("passes_ms").contains("box_filter"));
    EXPECT_EQ(lists[i].at("fragments"), lists[0].at("fragments"));
    EXPECT_EQ(lists[i].at("exact"), true);
  }
  EXPECT_EQ(lists[1].at("stencil_mark"), "on");
  EXPECT_EQ(lists[2].at("stencil_mark"), "off");
}

TEST(Bench, MemoryBudgetsMakeTiles) {
  TemporaryFolder folder;
  const ProcessResult result =
      vitrail(folder, {"bench", "--scene", "mannequins", "--size", "240x135", "--repeat", "1", "--methods",
                       "linked-list,cpu", "--memory-budget", "1,64", "--samples", "4", "--json", "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const Json all = readJson(folder.file("a.json")).at("scenes")[0].at("measurements");
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[1].at("memory_budget_mib"), 1);
  EXPECT_GT(all[1].at("tiles"), 1);
  EXPECT_LE(all[1].at("memory_bytes"), (1 << 20) + 4096);
  EXPECT_EQ(all[2].at("memory_budget_mib"), 64);
  EXPECT_EQ(all[2].at("tiles"), 1);
  EXPECT_EQ(all[1].at("fragments"), all[2].at("fragments"));
  EXPECT_EQ(all[4].at("setting"), "cpu, in 64 MiB");
  EXPECT_TRUE(all[0].at("memory_budget_mib").is_null());
  EXPECT_NE(result.out.find("in 1 MiB drew "), std::string::npos) << result.out;
}

TEST(Bench, AnOverflowIsMeasuredAndSaid) {
  for (const std::string resolve : {"compute", "fragment"}) {
    const TemporaryFolder folder;
    const Json lists = listsOf(folder, {"--overflow", "approximate", "--node-capacity", "100,1000000", "--resolve",
                                        resolve, "--csv", "a.csv"});
    ASSERT_EQ(lists.size(), 2U);
    EXPECT_EQ(lists[0].at("node_capacity"), 100);
    EXPECT_EQ(lists[0].at("overflowed"), true);
    EXPECT_EQ(lists[0].at("exact"), false);
    EXPECT_EQ(lists[0].at("fragments").at("stored"), 100);
    EXPECT_GT(lists[0].at("fragments").at("missing"), 0);
    EXPECT_EQ(lists[1].at("overflowed"), false);
    EXPECT_EQ(lists[1].at("exact"), true);
    EXPECT_EQ(lists[1].at("fragments").at("requested"), lists[0].at("fragments").at("requested"));
    const std::vector<Words> rows = readCsv(folder.file("a.csv"));
    const auto column = std::ranges::find(rows[0], "overflowed") - rows[0].begin();
    EXPECT_EQ(rows.at(2).at(static_cast<std::size_t>(column)), "true");
    EXPECT_EQ(rows.at(3).at(static_cast<std::size_t>(column)), "false");
  }
}

// The same picture as the library's resolve, to the last bit of rounding, as long as no list is longer than its array.
TEST(Insertion, DrawsThePictureOfTheLinkedList) {
  const std::vector<Words> scenes = {{"--scene", "interlocked"},
                                     {"--scene", "flames"}, // additive
                                     {"--scene", "hairball"},
                                     {VITRAIL_TEST_CORPUS "/good/transmission.gltf"}}; // two fragments a surface
  for (const Words& scene : scenes) {
    SCOPED_TRACE(scene.back());
    const TemporaryFolder folder;
    for (const char* method : {"linked-list", "insertion"}) {
      const std::string name = method;
      Words words = {"render", "--size", "160x90", "--method", name, "--validate", "-o", name + ".png"};
      if (name == "linked-list")
        words.insert(words.end(), {"--list-build", "fragment", "--nodes", "standard"}); // as insertion
      words.insert(words.end(), {"--json", name + ".json"});
      words.insert(words.end(), scene.begin(), scene.end());
      const ProcessResult result = vitrail(folder, words);
      ASSERT_EQ(result.exitCode, 0) << result.error;
    }
    const Json lists = readJson(folder.file("linked-list.json"));
    const Json insertion = readJson(folder.file("insertion.json"));
    EXPECT_EQ(insertion.at("method"), "insertion");
    ASSERT_LE(lists.at("layers").at("max"), 128);
    EXPECT_EQ(insertion.at("error_bound_255"), lists.at("error_bound_255")); // complete, with 8 bits of alpha
    EXPECT_GT(insertion.at("error_bound_255"), 1.0);
    EXPECT_EQ(insertion.at("exact"), false);
    EXPECT_EQ(insertion.at("fragments"), lists.at("fragments"));
    EXPECT_EQ(insertion.at("layers"), lists.at("layers"));
    const ReadPng a = readPng(folder.file("linked-list.png"));
    const ReadPng b = readPng(folder.file("insertion.png"));
    ASSERT_EQ(a.rgba.size(), b.rgba.size());
    int largest = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) largest = std::max(largest, std::abs(a.rgba[i] - b.rgba[i]));
    EXPECT_LE(largest, 1);
  }
}

// What does not fit into the array is missing, and the report says so.
TEST(Insertion, ReportsWhatItDrops) {
  const TemporaryFolder folder;
  const ProcessResult result =
      vitrail(folder, {"render", "--scene", "planes", "--count", "150", "--size", "32x32", "--method", "insertion",
                       "--validate", "-o", "a.png", "--json", "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.error;
  const Json json = readJson(folder.file("a.json"));
  EXPECT_EQ(json.at("exact"), false);
  EXPECT_EQ(json.at("layers").at("max"), 150);
  EXPECT_EQ(json.at("fragments").at("requested"), 150 * 32 * 32);
  EXPECT_EQ(json.at("fragments").at("missing"), 22 * 32 * 32);
}

} // namespace
} // namespace vitrail::tests
