// What `vitrail info MODEL` tells, of a model that is made up.
#include "report/model_info.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "reference/test_scenes.h"

namespace vitrail::tests {
namespace {

using namespace vitrail::tool;

ModelInfo glass() {
  ModelInfo model{"models/glass.glb", 12'345, {}};
  Scene& scene = model.scene;
  reference::addRectangle(scene, {{-1.0F, -2.0F}, {3.0F, 2.0F}, 0.5F}, reference::unlitMaterial(glm::vec4(0.5F)));
  scene.draws.push_back(scene.draws[0]);
  scene.materials[0].name = "pane";
  scene.materials[0].baseColorTexture.image = 0;
  scene.images.push_back({4, 2, std::vector<std::uint8_t>(32)});
  scene.origin = {500'000.0, 4'649'776.0, 0.0};
  scene.file.format = "glTF 2.0 (binary)";
  scene.file.generator = "by hand";
  scene.file.extensions = {{"KHR_materials_unlit", false, true, ""},
                           {"KHR_materials_sheen", true, false, "fabrics lack their soft rim"}};
  scene.file.animations = {{"Walk", 2.5}};
  scene.file.variants = {"rainy"};
  scene.lights.push_back({Light::Kind::Spot, "lamp"});
  scene.cameras.emplace_back();
  scene.warnings = {"something is lost"};
  return model;
}

TEST(ModelInfo, TextForPeople) {
  const std::string text = toText(glass());
  for (const char* part :
       {"models/glass.glb\n", "glTF 2.0 (binary), 12.3 kB", "by hand", "4 x 4 x 0", "499999, 4649774, 0.5",
        "500003, 4649778, 0.5", "1: 2 triangles, 4 vertices", "2 times: 4 triangles, 8 vertices",
        "0 \"pane\": blend, alpha 0.5, ", "unlit, base colour of image 0", "0: 4x2", "KHR_materials_unlit: drawn\n",
        "KHR_materials_sheen: not drawn, required; fabrics lack their soft rim", "\"lamp\": spot", "45 degrees",
        "\"Walk\": 2.5 s", "rainy", "something is lost"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
}

TEST(ModelInfo, LongListsAreCut) {
  ModelInfo model = glass();
  model.scene.materials.resize(300);
  const std::string text = toText(model);
  EXPECT_NE(text.find("materials      300\n"), std::string::npos) << text;
  EXPECT_NE(text.find("and 280 more"), std::string::npos) << text;
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 60);
}

TEST(ModelInfo, NamesOfFilesCannotControlATerminal) {
  ModelInfo model = glass();
  model.scene.materials[0].name = "a\x1b[2Jb\nc";
  const std::string text = toText(model);
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_EQ(text.find("b\nc"), std::string::npos);
}

TEST(ModelInfo, JsonForPrograms) {
  const std::vector<ModelInfo> models{glass()};
  const nlohmann::json json = nlohmann::json::parse(toJson(models)).at("models").at(0);
  EXPECT_EQ(json.at("file"), "models/glass.glb");
  EXPECT_EQ(json.at("bytes"), 12'345);
  EXPECT_EQ(json.at("bounds").at("min"), nlohmann::json({499'999.0, 4'649'774.0, 0.5}));
  EXPECT_EQ(json.at("meshes").at("triangles"), 2);
  EXPECT_EQ(json.at("draws").at("triangles"), 4);
  EXPECT_EQ(json.at("materials").at(0).at("alpha_mode"), "blend");
  EXPECT_EQ(json.at("materials").at(0).at("textures").at("base colour"), 0);
  EXPECT_EQ(json.at("extensions").at(1).at("lost"), "fabrics lack their soft rim");
  EXPECT_EQ(json.at("extensions").at(0).at("lost"), nullptr);
  EXPECT_EQ(json.at("animations").at(0).at("seconds"), 2.5);
  EXPECT_EQ(json.at("variants"), nlohmann::json({"rainy"}));
  EXPECT_EQ(json.at("lights").at(0).at("kind"), "spot");
  EXPECT_EQ(json.at("warnings").size(), 1U);
}

} // namespace
} // namespace vitrail::tests
