// How glTF files hang together: hierarchies, instances, lights, variants, extensions, places far away.
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "load_good.h"
#include "scene/gltf/extensions.h"
#include "scene/load.h"
#include "scene/visibility.h"

namespace vitrail::tool {
namespace {

using Lines = std::vector<std::string>;

TEST(GltfHierarchy, ARootIsDrawnWithoutTheParentThatItsSceneLeavesOut) {
  const Scene scene = loadGood("root_is_child.gltf");
  ASSERT_EQ(scene.draws.size(), 1U);
  expectNear(placed(scene, 0, {}), {0.0F, 0.0F, 0.0F});
  EXPECT_EQ(scene.warnings,
            (Lines{"scene 0: lists node 0 as a root, but not its parent, node 1 \"outside\": it is drawn "
                   "without the parent's transform"}));
  EXPECT_TRUE(loadGood("root_is_child_in_place.gltf").warnings.empty()) << "the parent moves nothing";
}

TEST(GltfHierarchy, WhatASceneListsTwiceIsDrawnOnceWhereItsParentIs) {
  const Scene scene = loadGood("all_nodes_listed.gltf");
  ASSERT_EQ(scene.draws.size(), 1U);
  expectNear(placed(scene, 0, {}), {5.0F, 1.0F, 0.0F});
  EXPECT_EQ(scene.warnings,
            (Lines{"scene 0: lists node 1 twice: it is drawn once",
                   "scene 0: lists node 0 as a root, which is below another one: it is drawn there alone"}));
}

TEST(GltfHierarchy, ANodeWithTwoParentsIsDrawnBelowEach) {
  const Scene scene = loadGood("node_two_parents.gltf");
  ASSERT_EQ(scene.draws.size(), 2U);
  expectNear(placed(scene, 0, {}), {1.0F, 0.0F, 0.0F});
  expectNear(placed(scene, 1, {}), {0.0F, 1.0F, 0.0F});
  EXPECT_EQ(scene.warnings, (Lines{"node 2 is a child of node 0 and of node 1: it is drawn below each",
                                   "node 0 lists a child twice: it is drawn once"}));
}

TEST(GltfHierarchy, HiddenNodesHideAllBelowThem) {
  const Scene scene = loadGood("visibility.gltf");
  EXPECT_EQ(scene.draws.size(), 1U);
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfHierarchy, AFileThatHidesAllIsAnEmptyPicture) {
  const Scene scene = loadGood("all_hidden.gltf");
  EXPECT_TRUE(scene.draws.empty());
  EXPECT_EQ(scene.warnings, (Lines{"nothing of the model is seen: all of its nodes are hidden"}));
  const View view = frameScene(scene, Orbit{}, 1.5F);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(std::isfinite(view.cameraToWorld[3][i]));
  EXPECT_GT(view.farPlane, view.nearPlane);
  EXPECT_EQ(whyNothingIsSeen(scene, {view, 64, 64, {}}), "all of its nodes are hidden");
}

TEST(GltfHierarchy, WhatIsWrongAndCanBeLeftOutRefusesNoFile) {
  const Scene scene = loadGood("parts_left_out.gltf");
  EXPECT_EQ(scene.warnings, (Lines{"node 0: rotation is zero, not a quaternion: it is not rotated",
                                   "KHR_materials_variants: names a material or a variant that is not there",
                                   "image 1: gone.png: no such file; the material is drawn without it",
                                   "camera 0: yfov is not between 0 and pi; the camera is left out",
                                   "camera 1: perspective.znear is missing; the camera is left out"}));
  ASSERT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(scene.cameras[0].name, "right");
  expectNear(placed(scene, 0, {1.0F, 2.0F, 3.0F}), {1.0F, 2.0F, 3.0F});
  EXPECT_EQ(scene.materials.at(0).baseColorTexture.image, 0);
  EXPECT_EQ(scene.materials[0].emissive, glm::vec3(0.0F)) << "not white all over";
  LoadOptions options;
  options.variant = "day";
  EXPECT_EQ(refusalOf("parts_left_out.gltf", options),
            "KHR_materials_variants: the variant has material 7, but materials has 1 element");
}

TEST(LoadOptions, WhatIsOptionalNeedNotBeThere) {
  LoadOptions options;
  options.time = 1.0;
  options.animation = "fly";
  options.variant = "dusk";
  options.optional = true;
  for (const char* file : {"triangle.gltf", "box.obj", "variants.gltf", "animations.gltf"})
    EXPECT_EQ(refusalOf(file, options), "");
  const Scene scene = loadGood("animations.gltf", options);
  EXPECT_FALSE(hasAnimation(scene.file, options));
  options.animation = "rise";
  EXPECT_TRUE(hasAnimation(scene.file, options));
  EXPECT_FALSE(hasVariant(scene.file, options));
}

TEST(GltfHierarchy, InstancesAreADrawEach) {
  const Scene scene = loadGood("instancing.gltf");
  ASSERT_EQ(scene.draws.size(), 2U);
  EXPECT_EQ(scene.meshes.size(), 1U);
  EXPECT_TRUE(scene.warnings.empty());
  expectNear(placed(scene, 0, {1.0F, 0.0F, 0.0F}), {1.0F, 10.0F, 0.0F});
  // Doubled, turned from x to y, moved by 3 along x, and by the node's 10 along y.
  expectNear(placed(scene, 1, {1.0F, 0.0F, 0.0F}), {3.0F, 12.0F, 0.0F});
}

TEST(GltfGeometry, IsKeptOnceHoweverManyMeshesUseIt) {
  const Scene scene = loadGood("shared_geometry.gltf");
  ASSERT_EQ(scene.draws.size(), 3U);
  EXPECT_EQ(scene.meshes.size(), 2U) << "the third mesh has indices of its own";
  EXPECT_EQ(scene.draws[0].mesh, scene.draws[1].mesh);
  EXPECT_NE(scene.draws[0].material, scene.draws[1].material);
  EXPECT_NE(scene.draws[0].mesh, scene.draws[2].mesh);
}

TEST(GltfGeometry, PlacesFarAwayKeepTheirPrecision) {
  const Scene scene = loadGood("far_away.gltf");
  EXPECT_GT(glm::length(scene.origin), 4e6);
  // A float would be up to a quarter off.
  EXPECT_EQ(placed(scene, 0, {}), glm::dvec3(500000.25, 0.0, 4649776.25));
  EXPECT_EQ(placed(scene, 0, {0.0F, 1.0F, 0.0F}), glm::dvec3(500000.25, 1.0, 4649776.25));
  EXPECT_EQ(scene.origin + glm::dvec3(scene.cameras.at(0).cameraToWorld[3]), glm::dvec3(500000.25, 0.0, 4649780.25));
  EXPECT_EQ(scene.origin + glm::dvec3(scene.lights.at(0).position), glm::dvec3(500000.25, 0.5, 4649776.25));
  EXPECT_EQ(loadGood("no_scenes.gltf").origin, glm::dvec3(0.0)) << "what is near keeps its own numbers";
}

TEST(GltfLights, ShineWhereTheirNodesAre) {
  const Scene scene = loadGood("lights.gltf");
  ASSERT_EQ(scene.lights.size(), 3U);
  const Light& sun = scene.lights[0];
  EXPECT_EQ(sun.kind, Light::Kind::Directional);
  EXPECT_EQ(sun.name, "sun");
  expectNear(sun.intensity, {2.0F, 1.0F, 0.0F});
  expectNear(sun.direction, {0.0F, 1.0F, 0.0F});
  const Light& point = scene.lights[1];
  EXPECT_EQ(point.kind, Light::Kind::Point);
  expectNear(glm::vec3(scene.origin) + point.position, {1.0F, 2.0F, 4.0F});
  EXPECT_EQ(point.range, 7.0F);
  expectNear(point.intensity, {1.0F, 1.0F, 1.0F});
  const Light& spot = scene.lights[2];
  EXPECT_EQ(spot.kind, Light::Kind::Spot);
  expectNear(spot.direction, {-1.0F, 0.0F, 0.0F});
  EXPECT_EQ(spot.range, 0.0F);
  EXPECT_EQ(spot.innerConeAngle, 0.25F);
  EXPECT_EQ(spot.outerConeAngle, 0.5F);
  const std::string unknown = "light 3 is neither directional nor a point nor a spot: it does not shine";
  EXPECT_EQ(std::ranges::count(scene.warnings, unknown), 1);
}

TEST(GltfVariants, ChooseTheMaterials) {
  const auto names = [](const std::optional<std::string>& variant) {
    LoadOptions options;
    options.variant = variant;
    const Scene scene = loadGood("variants.gltf", options);
    Lines result;
    for (const Draw& draw : scene.draws) result.push_back(scene.materials.at(draw.material).name);
    EXPECT_EQ(scene.meshes.size(), 1U);
    EXPECT_TRUE(scene.warnings.empty());
    return result;
  };
  EXPECT_EQ(names({}), (Lines{"plain", "plain"}));
  EXPECT_EQ(names("day"), (Lines{"plain", "bright"}));
  EXPECT_EQ(names("night"), (Lines{"plain", "dark"}));
  EXPECT_EQ(loadGood("variants.gltf").file.variants, (Lines{"day", "night"}));
}

TEST(GltfVariants, UnknownOnesAreRefusedWithTheNamesThatThereAre) {
  LoadOptions options;
  options.variant = "dusk";
  EXPECT_EQ(refusalOf("variants.gltf", options), "has no variant \"dusk\"; it has \"day\", \"night\"");
  EXPECT_EQ(refusalOf("triangle.gltf", options), "has no variants of its materials");
  EXPECT_EQ(refusalOf("triangle.glb", options), "has no variants of its materials");
  EXPECT_EQ(refusalOf("box.obj", options), "has no variants of its materials: files of its format cannot");
}

TEST(GltfExtensions, ThoseOfWhatIsDrawnAreSaidOnceWithWhatIsLost) {
  const Scene scene = loadGood("extensions.gltf");
  EXPECT_EQ(scene.warnings,
            (Lines{"the extension MSFT_lod is not drawn: only the most detailed level is drawn",
                   "the extension EXAMPLE_unknown is not drawn: what it adds to the picture is missing",
                   "the extension EXAMPLE_required is not drawn: what it adds to the picture is missing"}))
      << "neither those of nodes that are not drawn, nor those that are nowhere";
}

TEST(GltfExtensions, AllOfAFileAreListed) {
  const FileFacts facts = loadGood("extensions.gltf").file;
  EXPECT_EQ(facts.format, "glTF 2.0");
  EXPECT_EQ(loadGood("triangle.glb").file.format, "glTF 2.0 (binary)");
  EXPECT_EQ(facts.generator, "make_corpus.py");
  ASSERT_EQ(facts.extensions.size(), 6U);
  const auto named = [&](const std::string& name) {
    return *std::ranges::find(facts.extensions, name, &FileFacts::Extension::name);
  };
  EXPECT_FALSE(named("MSFT_lod").honoured);
  EXPECT_FALSE(named("MSFT_lod").required);
  EXPECT_NE(named("MSFT_lod").lost, "");
  EXPECT_TRUE(named("EXAMPLE_required").required);
  EXPECT_EQ(named("KHR_xmp_json_ld").lost, "") << "it loses nothing";
  const FileFacts quantized = loadGood("normalized.gltf").file;
  ASSERT_EQ(quantized.extensions.size(), 1U);
  EXPECT_TRUE(quantized.extensions[0].honoured);
  EXPECT_TRUE(quantized.extensions[0].required);
}

TEST(GltfExtensions, TheTableHasANameOnce) {
  const std::span<const GltfExtension> rows = gltfExtensions();
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = i + 1; j < rows.size(); ++j) EXPECT_NE(rows[i].name, rows[j].name);
  for (const GltfExtension& row : rows) {
    const bool loses = row.support != GltfSupport::Drawn && row.support != GltfSupport::Nothing;
    EXPECT_EQ(loses, !row.lost.empty()) << row.name;
  }
}

} // namespace
} // namespace vitrail::tool
