// `vitrail pick`, and pictures of a part of a model: --peel, --hide, --show, --isolate.
#include <gtest/gtest.h>

#include <fstream>

#include "png_reader.h"
#include "vitrail.h"

namespace vitrail::tests {
namespace {

// Two walls one behind the other, a draw each, which the materials name.
void writeWalls(const TemporaryFolder& folder) {
  std::ofstream(folder.file("walls.mtl")) << "newmtl near\nKd 1 0 0\nd 0.5\nnewmtl far\nKd 0 0 1\nd 0.5\n";
  std::ofstream(folder.file("walls.obj"))
      << "mtllib walls.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n"
         "usemtl near\nf 1 2 3 4\nusemtl far\nf 5 6 7 8\n";
}

ReadPng drawWalls(const TemporaryFolder& folder, Words words) {
  words.insert(words.begin(), {"render", "walls.obj", "--size", "32x32", "-o", "a.png"});
  const ProcessResult result = vitrail(folder, words);
  EXPECT_EQ(result.exitCode, 0) << result.error;
  return result.exitCode == 0 ? readPng(folder.file("a.png")) : ReadPng{};
}

TEST(Inside, PickListsTheLayersOfAPixel) {
  const TemporaryFolder folder;
  writeWalls(folder);
  const Words words = {"pick", "walls.obj", "--orbit", "0,0", "--size", "32x32", "--at", "16,16"};
  Words asJson = words;
  asJson.emplace_back("--json");
  const ProcessResult json = vitrail(folder, asJson);
  ASSERT_EQ(json.exitCode, 0) << json.error;
  const Json layers = Json::parse(json.out)["layers"];
  ASSERT_EQ(layers.size(), 2U);
  EXPECT_EQ(layers[0]["object"], "near");
  EXPECT_EQ(layers[1]["object"], "far");
  EXPECT_NEAR(layers[1]["depth"].get<double>() - layers[0]["depth"].get<double>(), 1.0, 1e-4);
  EXPECT_NEAR(layers[0]["alpha"].get<double>(), 0.5, 1e-6);
  EXPECT_NEAR(layers[1]["point"][2].get<double>(), -1.0, 1e-4);
  const ProcessResult text = vitrail(folder, words);
  EXPECT_EQ(std::count(text.out.begin(), text.out.end(), '\n'), 2) << text.out;
  EXPECT_LT(text.out.find("near"), text.out.find("far"));
  Words corner = words;
  corner.back() = "0,0";
  EXPECT_EQ(vitrail(folder, corner).out, "nothing is there but the background\n");
}

TEST(Inside, PartsAreHiddenShownIsolatedAndPeeled) {
  const TemporaryFolder folder;
  writeWalls(folder);
  const ReadPng all = drawWalls(folder, {"--eye", "0,0,3"});
  const ReadPng far = drawWalls(folder, {"--hide", "near", "--eye", "0,0,3"});
  const ReadPng alone = drawWalls(folder, {"--isolate", "far", "--eye", "0,0,3"});
  const ReadPng peeled = drawWalls(folder, {"--peel", "1", "--eye", "0,0,3"});
  const ReadPng shown = drawWalls(folder, {"--isolate", "near", "--show", "far", "--eye", "0,0,3"});
  EXPECT_EQ(far.rgba, alone.rgba);
  EXPECT_EQ(all.rgba, shown.rgba);
  const std::size_t middle = 4 * (16 * 32 + 16);
  EXPECT_EQ(peeled.rgba[middle], alone.rgba[middle]);
  EXPECT_GT(alone.rgba[middle + 2], alone.rgba[middle]);
}

// On the processor and on a GPU, in words and in the report.
TEST(Inside, APeeledPictureSaysWhatItLacks) {
  const TemporaryFolder folder;
  writeWalls(folder);
  for (const Words& how : {Words{}, Words{"--method", "linked-list", "--device", "llvmpipe"}}) {
    Words words{"render", "walls.obj", "-o",     "a.png",  "--size", "32x32",
                "--eye",  "0,0,3",     "--json", "a.json", "--peel"};
    words.emplace_back("2");
    words.insert(words.end(), how.begin(), how.end());
    const ProcessResult result = vitrail(folder, words);
    EXPECT_NE(result.out.find("exact without the 2 nearest surfaces of each pixel"), std::string::npos) << result.out;
    EXPECT_EQ(Json::parse(readText(folder.file("a.json")))["peeled"], 2);
  }
}

TEST(Inside, WhatCannotBeDoneIsRefused) {
  const TemporaryFolder folder;
  writeWalls(folder);
  const auto refuse = [&](Words words, int code, const std::string& reason) {
    expectRefusal(folder, kTool, words, code, reason);
  };
  refuse({"pick", "walls.obj"}, 2, "--at");
  refuse({"pick", "walls.obj", "--at", "5"}, 2, "'5' is not a pixel");
  refuse({"pick", "walls.obj", "--at", "32,0", "--size", "32x32"}, 2, "the last one is 31,31");
  refuse({"pick", "walls.obj", "--at", "1,1", "--hide", "door"}, 2, "there are \"near\", \"far\"");
  refuse({"render", "walls.obj", "-o", "a.png", "--isolate", "door"}, 2, "no object is named");
  refuse({"render", "walls.obj", "-o", "a.png", "--peel", "0"}, 2, "--peel");
  refuse({"render", "walls.obj", "-o", "a.png", "--fade", "near"}, 2, "NAME=A");
  refuse({"render", "walls.obj", "-o", "a.png", "--fade", "near=2"}, 2, "NAME=A");
  refuse({"render", "walls.obj", "-o", "a.png", "--fade", "door=0.5"}, 2, "no object is named");
  refuse({"render", "walls.obj", "-o", "a.png", "--peel", "1", "--method", "weighted"}, 2, "linked-list, cpu");
  refuse({"render", "walls.obj", "-o", "a.png", "--peel", "1", "--layers", "2"}, 2, "leave --layers out");
  refuse({"render", "walls.obj", "-o", "a.png", "--peel", "1", "--sorting", "off"}, 2, "leave --sorting out");
  refuse({"render", "walls.obj", "-o", "a.png", "--sorting", "off", "--layers", "2"}, 2, "leave --layers out");
  refuse({"render", "walls.obj", "-o", "a.png", "--sorting", "off", "--method", "weighted"}, 2, "linked-list");
  refuse({"render", "walls.obj", "-o", "a.png", "--peel", "1", "--api", "opengl"}, 2, "--peel");
}

} // namespace
} // namespace vitrail::tests
