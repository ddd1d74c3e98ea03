// The built-in scenes: the same values every time, sound geometry, and what each promises about itself.
#include "scene/builtin/builtin.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "mesh_checks.h"
#include "scene/builtin/random.h"

namespace vitrail::tool::test {
namespace {

Scene make(std::string_view name, std::optional<std::uint32_t> count = {}, std::uint32_t seed = 1) {
  return makeBuiltinScene(name, {count, seed});
}

bool sameMesh(const Mesh& a, const Mesh& b) {
  return a.indices == b.indices && a.positions == b.positions && a.normals == b.normals && a.tangents == b.tangents &&
         a.texCoords0 == b.texCoords0 && a.texCoords1 == b.texCoords1 && a.colors == b.colors;
}

bool sameScene(const Scene& a, const Scene& b) {
  const auto sameImage = [](const Image& x, const Image& y) { return x.width == y.width && x.rgba == y.rgba; };
  const auto sameMaterial = [](const Material& x, const Material& y) {
    return x.name == y.name && x.baseColor == y.baseColor && x.roughness == y.roughness &&
           x.baseColorTexture.image == y.baseColorTexture.image;
  };
  const auto sameDraw = [](const Draw& x, const Draw& y) {
    return x.mesh == y.mesh && x.material == y.material && x.transform == y.transform;
  };
  return std::ranges::equal(a.meshes, b.meshes, sameMesh) && std::ranges::equal(a.images, b.images, sameImage) &&
         std::ranges::equal(a.materials, b.materials, sameMaterial) && std::ranges::equal(a.draws, b.draws, sameDraw);
}

// Empty: every part refers to parts that exist, and every value is in its range. Else what is wrong.
std::string sceneFault(const Scene& scene) {
  if (scene.draws.empty()) return "no draw";
  for (const Mesh& mesh : scene.meshes) {
    if (std::string fault = meshFault(mesh); !fault.empty()) return fault;
  }
  for (const Image& image : scene.images) {
    if (image.rgba.size() != std::size_t{4} * image.width * image.height) return "the size of an image";
  }
  std::set<std::string> names;
  for (const Material& material : scene.materials) {
    if (material.name.empty() || !names.insert(material.name).second) return "the name of " + material.name;
    if (material.baseColorTexture.image >= static_cast<int>(scene.images.size()))
      return "the image of " + material.name;
    for (int i = 0; i < 4; ++i) {
      if (!(material.baseColor[i] >= 0.0F && material.baseColor[i] <= 1.0F)) return "the colour of " + material.name;
    }
    if (material.alphaMode == AlphaMode::Opaque && material.baseColor.a != 1.0F) return "the alpha of " + material.name;
  }
  for (const Draw& draw : scene.draws) {
    if (draw.mesh >= scene.meshes.size() || draw.material >= scene.materials.size()) return "what a draw refers to";
    if (!(glm::determinant(glm::mat3(draw.transform)) > 0.0F)) return "a transform that mirrors or flattens";
  }
  return {};
}

TEST(Random, IsTheReferenceGenerator) {
  Random random(42, 54); // the published test vector of PCG32
  for (const std::uint32_t value : {0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU, 0xcbed606eU}) {
    EXPECT_EQ(random.next(), value);
  }
}

TEST(Random, StaysInItsRanges) {
  Random random(7);
  for (int i = 0; i < 10000; ++i) {
    const float uniform = random.uniform();
    EXPECT_TRUE(uniform >= 0.0F && uniform < 1.0F);
    EXPECT_LT(random.below(3), 3U);
    EXPECT_LE(glm::length(random.inBall()), 1.0F);
    EXPECT_TRUE(isUnit(random.direction()));
  }
}

TEST(Random, ShuffleKeepsEveryItem) {
  std::vector<int> items{0, 1, 2, 3, 4, 5, 6, 7};
  Random random(3);
  random.shuffle(items);
  EXPECT_NE(items, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
  std::ranges::sort(items);
  EXPECT_EQ(items, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
}

class EveryScene : public testing::TestWithParam<std::size_t> {
 protected:
  static const BuiltinScene& entry() { return builtinScenes()[GetParam()]; }
};

TEST_P(EveryScene, IsSound) {
  const Scene scene = make(entry().name);
  EXPECT_EQ(sceneFault(scene), "");
  EXPECT_EQ(scene.name, entry().name);
  EXPECT_FALSE(entry().summary.empty());
  EXPECT_FALSE(entry().countMeaning.empty());
  EXPECT_LT(triangleCount(scene), 2'000'000U);
  const Bounds bounds = worldBounds(scene);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(bounds.min[axis], bounds.max[axis]);
    EXPECT_LT(std::max(std::abs(bounds.min[axis]), std::abs(bounds.max[axis])), 65.0F);
  }
}

TEST_P(EveryScene, IsSoundForOtherCountsAndSeeds) {
  for (const std::uint32_t count : {1U, 2U, 3U, 5U, 10U, 17U}) {
    EXPECT_EQ(sceneFault(make(entry().name, count, count)), "") << count;
  }
}

TEST_P(EveryScene, IsAFunctionOfItsSeed) {
  const Scene scene = make(entry().name, 20, 5);
  EXPECT_TRUE(sameScene(scene, make(entry().name, 20, 5)));
  EXPECT_FALSE(sameScene(scene, make(entry().name, 20, 6)));
}

TEST_P(EveryScene, RefusesCountsOutOfRange) {
  EXPECT_THROW(make(entry().name, 0), std::invalid_argument);
  EXPECT_THROW(make(entry().name, entry().maxCount + 1), std::invalid_argument);
  EXPECT_GE(entry().maxCount, entry().defaultCount);
}

INSTANTIATE_TEST_SUITE_P(Builtin, EveryScene, testing::Range<std::size_t>(0, builtinScenes().size()),
                         [](const auto& each) { return std::string(builtinScenes()[each.param].name); });

TEST(Builtin, NamesTheKnownScenesForAnUnknownOne) {
  try {
    make("cube");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(
        std::string(error.what()),
        "there is no scene \"cube\"; the scenes are spheres, planes, interlocked, mannequins, hairball, smoke, flames");
  }
}

TEST(Builtin, SaysWhichCountsASceneCanHave) {
  try {
    make("planes", 5001);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()), "the scene planes can have 1 to 5000 panes, not 5001");
  }
}

TEST(Builtin, SpheresShareOneMesh) {
  for (const std::uint32_t count : {64U, 4000U}) {
    const Scene scene = make("spheres", count);
    EXPECT_EQ(scene.meshes.size(), 1U);
    EXPECT_EQ(scene.draws.size(), count);
    EXPECT_EQ(scene.materials.size(), count);
    for (const Material& material : scene.materials) {
      EXPECT_EQ(material.alphaMode, AlphaMode::Blend);
      EXPECT_EQ(material.metallic, 0.0F);
      EXPECT_TRUE(material.baseColor.a >= 0.2F && material.baseColor.a <= 1.0F);
    }
  }
}

// The distance of a linear colour from the nearest 8-bit sRGB one, in steps.
double offGrid(double linear) {
  const double srgb = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
  return std::abs(255.0 * srgb - std::round(255.0 * srgb));
}

TEST(Builtin, PlanesAre32WhereNobodySaysHowMany) { EXPECT_EQ(make("planes").draws.size(), 32U); }

TEST(Builtin, PlanesAreOnTheGrid) {
  for (const std::uint32_t count : {32U, 5000U}) {
    const Scene scene = make("planes", count);
    std::set<float> depths;
    for (const Draw& draw : scene.draws) {
      const Material& material = scene.materials[draw.material];
      EXPECT_TRUE(material.unlit);
      EXPECT_EQ(material.alphaMode, AlphaMode::Blend);
      for (int i = 0; i < 3; ++i) EXPECT_LT(offGrid(static_cast<double>(material.baseColor[i])), 1e-3);
      const float steps = material.baseColor.a * 255.0F;
      EXPECT_EQ(material.baseColor.a, std::round(steps) / 255.0F);
      EXPECT_TRUE(steps >= 0.5F && steps < 129.0F);
      depths.insert(draw.transform[3].z);
    }
    EXPECT_EQ(depths.size(), count);
    EXPECT_FALSE(std::ranges::is_sorted(scene.draws, {}, [](const Draw& draw) { return draw.transform[3].z; }));
    EXPECT_FALSE(std::ranges::is_sorted(scene.draws, {}, [](const Draw& draw) { return -draw.transform[3].z; }));
  }
}

TEST(Builtin, PlanesFillThePictureAtDistinctDepths) {
  const Scene scene = make("planes", 5000);
  ASSERT_EQ(scene.cameras.size(), 1U);
  const View view = viewOf(scene.cameras[0]);
  for (const float aspect : {0.02F, 1.0F, 16.0F / 9.0F, 60.0F}) {
    std::set<float> depths;
    for (const Draw& draw : scene.draws) {
      const glm::mat4 clip = projectionMatrix(view, aspect) * viewMatrix(view) * draw.transform;
      const glm::vec4 corner = clip * glm::vec4(scene.meshes[draw.mesh].positions[0], 1.0F);
      EXPECT_LT(corner.x, -1.0F);
      EXPECT_LT(corner.y, -1.0F);
      EXPECT_TRUE(corner.z > 0.0F && corner.z < 1.0F);
      depths.insert(corner.z);
    }
    EXPECT_EQ(depths.size(), scene.draws.size());
  }
}

TEST(Builtin, MannequinsHaveASkyAndOpaqueTeapots) {
  const Scene scene = make("mannequins");
  ASSERT_TRUE(scene.background.has_value());
  EXPECT_EQ(scene.background->kind, Background::Kind::Sky);
  const auto count = [&scene](std::string_view prefix) {
    return std::ranges::count_if(scene.materials, [&](const Material& each) { return each.name.starts_with(prefix); });
  };
  EXPECT_EQ(count("figure"), 36);
  EXPECT_GE(count("teapot"), 1);
  // Nobody sinks into the stage, whose top is at height 0.
  for (const Draw& draw : scene.draws) {
    if (scene.materials[draw.material].name == "stage") continue;
    Scene alone;
    alone.meshes.push_back(scene.meshes[draw.mesh]);
    alone.draws.push_back({0, 0, draw.transform});
    EXPECT_GE(worldBounds(alone).min.y, 0.0F);
  }
}

TEST(Builtin, InterlockedHasPanesAndRings) {
  const Scene scene = make("interlocked");
  EXPECT_EQ(scene.draws.size(), 12U);
  EXPECT_EQ(scene.meshes.size(), 2U);
}

TEST(Builtin, HairballIsMadeOfClosedTubes) {
  for (const Mesh& mesh : make("hairball", 16).meshes) EXPECT_EQ(openEdges(mesh), 0U);
}

TEST(Builtin, SmokeFacesTheDefaultCameraInPlanesOfItsOwn) {
  const Scene scene = make("smoke");
  const glm::vec3 backward(frameScene(scene, Orbit{}, 1.0F).cameraToWorld[2]);
  std::set<float> depths;
  for (const Draw& draw : scene.draws) {
    EXPECT_LT(glm::distance(glm::normalize(glm::vec3(draw.transform[2])), backward), 1e-5F);
    depths.insert(glm::dot(glm::vec3(draw.transform[3]), backward));
  }
  EXPECT_EQ(depths.size(), scene.draws.size());
  EXPECT_FALSE(scene.images.empty());
  for (const Image& image : scene.images) {
    for (std::size_t i = 0; i < image.width; ++i) EXPECT_EQ(image.rgba[4 * i + 3], 0U); // clear at the border
  }
}

TEST(Builtin, FlamesAreSmokeThatAddsLight) {
  const Scene smoke = make("smoke");
  const Scene flames = make("flames");
  ASSERT_EQ(flames.draws.size(), smoke.draws.size());
  for (std::size_t i = 0; i < flames.draws.size(); ++i) {
    EXPECT_EQ(flames.draws[i].transform, smoke.draws[i].transform);
    EXPECT_EQ(flames.materials[flames.draws[i].material].blend, BlendMode::Additive);
    EXPECT_EQ(smoke.materials[smoke.draws[i].material].blend, BlendMode::Over);
  }
}

TEST(Scene, BoundsHoldDrawnTrianglesOnly) {
  Scene scene;
  Mesh mesh;
  for (const glm::vec3 position : {glm::vec3(0.0F), {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {9.0F, 9.0F, 9.0F}}) {
    mesh.positions.push_back(position);
  }
  mesh.indices = {0, 1, 2};
  scene.meshes.push_back(mesh);
  scene.meshes.push_back(mesh);
  glm::mat4 shifted(1.0F);
  shifted[3] = glm::vec4(-4.0F, 0.0F, 2.0F, 1.0F);
  scene.draws = {{0, 0, glm::mat4(1.0F)}, {0, 0, shifted}};
  EXPECT_EQ(worldBounds(scene).min, glm::vec3(-4.0F, 0.0F, 0.0F));
  EXPECT_EQ(worldBounds(scene).max, glm::vec3(1.0F, 1.0F, 2.0F));
  EXPECT_EQ(triangleCount(scene), 2U);
}

} // namespace
} // namespace vitrail::tool::test
