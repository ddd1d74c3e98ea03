// Which exact method draws where nobody named one: what is remembered of a device, and what follows from it.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "commands/method_choice.h"
#include "gpu/device.h"
#include "methods/methods.h"
#include "scene/builtin/builtin.h"
#include "vitrail.h"

namespace vitrail::tests {
namespace {

using tool::MethodCosts;

const MethodCosts kTilesAreFaster{{{50.0, 6.0}, {40.0, 3.0}}, {{900.0, 0.5}, {800.0, 0.4}}};
const MethodCosts kTilesAreSoonFaster{{{50.0, 6.0}, {40.0, 3.0}}, {{60.0, 0.5}, {50.0, 0.4}}};
const MethodCosts kListsAreFaster{{{50.0, 6.0}, {40.0, 3.0}}, {{900.0, 0.5}, {800.0, 3.5}}};
const MethodCosts kOnlyLists{{{50.0, 6.0}, {40.0, 3.0}}, {}};

TEST(MethodChoice, IsTheFasterOneOfEverySceneForSoManyPictures) {
  EXPECT_EQ(tool::fasterMethod(kTilesAreFaster, tool::kPicturesOfAWindow), tool::kTilesMethod);
  EXPECT_EQ(tool::fasterMethod(kTilesAreFaster, 400), tool::kTilesMethod);
  EXPECT_EQ(tool::fasterMethod(kTilesAreFaster, 100), tool::kListMethod); // 850 ms for 550
  EXPECT_EQ(tool::fasterMethod(kTilesAreFaster, 1), tool::kListMethod);
  EXPECT_EQ(tool::fasterMethod(kListsAreFaster, tool::kPicturesOfAWindow), tool::kListMethod);
  EXPECT_EQ(tool::fasterMethod(kOnlyLists, tool::kPicturesOfAWindow), tool::kListMethod);
}

TEST(MethodChoice, IsRememberedByDevice) {
  const TemporaryFolder folder;
  const std::filesystem::path memory = folder.path() / "a" / "methods.json";
  EXPECT_FALSE(tool::rememberedCosts(memory, "one"));
  tool::rememberCosts(memory, "one", kTilesAreFaster);
  tool::rememberCosts(memory, "two", kOnlyLists);
  EXPECT_EQ(tool::rememberedCosts(memory, "one"), kTilesAreFaster);
  EXPECT_EQ(tool::rememberedCosts(memory, "two"), kOnlyLists);
  EXPECT_FALSE(tool::rememberedCosts(memory, "three"));
  tool::rememberCosts(memory, "one", kListsAreFaster);
  EXPECT_EQ(tool::rememberedCosts(memory, "one"), kListsAreFaster);
  EXPECT_EQ(tool::rememberedCosts(memory, "two"), kOnlyLists);
  EXPECT_EQ(readJson(memory).at("devices").size(), 2U);
  for (int i = 0; i < 30; ++i) tool::rememberCosts(memory, std::to_string(i), kOnlyLists);
  EXPECT_EQ(readJson(memory).at("devices").size(), 16U); // it does not grow for ever
  EXPECT_TRUE(tool::rememberedCosts(memory, "29"));
}

TEST(MethodChoice, AnotherVersionMeasuresAnew) {
  const TemporaryFolder folder;
  const std::filesystem::path memory = folder.path() / "methods.json";
  tool::rememberCosts(memory, "one", kTilesAreFaster);
  Json json = readJson(memory);
  json["devices"][0]["version"] = "0.0.1";
  std::ofstream(memory) << json;
  EXPECT_FALSE(tool::rememberedCosts(memory, "one"));
}

TEST(MethodChoice, AFileThatIsNoneOfOursIsReplaced) {
  for (const char* text : {"", "{", "[]", R"({"devices": 1})", R"({"devices": [1, {}, {"device": 2}]})",
                           R"({"devices": [{"device": "one", "version": 3}]})"}) {
    const TemporaryFolder folder;
    const std::filesystem::path memory = folder.path() / "methods.json";
    std::ofstream(memory) << text;
    EXPECT_FALSE(tool::rememberedCosts(memory, "one")) << text;
    tool::rememberCosts(memory, "one", kTilesAreFaster);
    EXPECT_EQ(tool::rememberedCosts(memory, "one"), kTilesAreFaster) << text;
  }
  const TemporaryFolder folder;
  tool::rememberCosts(folder.path() / "methods.json", "one", kTilesAreFaster);
  tool::rememberCosts(folder.path() / "methods.json" / "below.json", "one", kTilesAreFaster); // a file is no folder
  EXPECT_EQ(folder.names(), std::vector<std::string>{"methods.json"});
}

// What is said of a turn on the first Vulkan device, of which that is remembered.
std::string summaryOfTurn(const MethodCosts& costs, int pictures, const Words& more) {
  const TemporaryFolder folder;
  const tool::DeviceSummary device = tool::listDevices().front();
  tool::rememberCosts(folder.path() / "vitrail" / "methods.json", device.identity, costs);
  Words words = {"render",  "--scene",     "interlocked",           "--size", "8x8", "--device", "0", "-o",
                 "a%d.png", "--turntable", std::to_string(pictures)};
  words.insert(words.end(), more.begin(), more.end());
  const ProcessResult result =
      vitrail(words, {.folder = folder.path(), .environment = cachesIn(folder.path()), .running = {}});
  EXPECT_EQ(result.exitCode, 0) << result.error;
  return result.out;
}

TEST(MethodChoice, OfTurns) {
  const auto isByTiles = [](const std::string& summary) { return summary.find(" tiles") != std::string::npos; };
  EXPECT_TRUE(isByTiles(summaryOfTurn(kTilesAreSoonFaster, 100, {})));
  EXPECT_FALSE(isByTiles(summaryOfTurn(kListsAreFaster, 100, {})));
  EXPECT_FALSE(isByTiles(summaryOfTurn(kTilesAreSoonFaster, 99, {})));
  // Where lists are asked for, or their numbers.
  for (const Words& words : {Words{"--peel", "1"}, Words{"--json", "a.json"}}) {
    EXPECT_FALSE(isByTiles(summaryOfTurn(kTilesAreSoonFaster, 100, words))) << words[0];
  }
}

TEST(MethodChoice, IsToldByInfo) {
  const TemporaryFolder folder;
  const tool::DeviceSummary device = tool::listDevices().front();
  const ProcessOptions options{.folder = {}, .environment = cachesIn(folder.path()), .running = {}};
  EXPECT_EQ(vitrail({"info"}, options).out.find("tiles in windows"), std::string::npos);
  tool::rememberCosts(folder.path() / "vitrail" / "methods.json", device.identity, kTilesAreFaster);
  EXPECT_NE(vitrail({"info"}, options).out.find("tiles in windows and turns: "), std::string::npos);
}

TEST(MethodChoice, OfASceneThatTilesDrawsOtherwiseIsLists) {
  tool::Scene scene = tool::makeBuiltinScene("spheres", {2});
  EXPECT_TRUE(tool::drawsAlike(scene));
  for (tool::Material& material : scene.materials) {
    material.transmission = 1.0F;
    material.thickness = 1.0F;
    material.attenuationDistance = 0.5F;
    material.attenuationColor = {0.5F, 0.9F, 0.5F};
  }
  EXPECT_FALSE(tool::drawsAlike(scene));
}

} // namespace
} // namespace vitrail::tests
