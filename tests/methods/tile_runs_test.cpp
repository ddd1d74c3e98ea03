// Tiles draw what reaches them and no more, and pictures in many tiles are those in one.
#include <cmath>
#include <optional>
#include <vector>

#include "../../tool/scene/builtin/builtin.h"
#include "../../tool/stage/frame_data.h"
#include "../../tool/stage/tile_runs.h"
#include "../reference/test_scenes.h"
#include "../thorough.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::straightView;
using reference::unlitMaterial;

constexpr std::uint32_t kTiledSide = 100;

// A material and a mesh, shown at these places: instances of one draw.
void addInstances(Scene& scene, const std::vector<glm::vec3>& places) {
  const std::uint32_t first =
      addRectangle(scene, {glm::vec2(-0.1F), glm::vec2(0.1F), 0.0F}, unlitMaterial({0.2F, 0.4F, 0.6F, 0.5F}));
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i > 0) scene.draws.push_back(scene.draws[first]);
    scene.draws.back().transform[3] = glm::vec4(places[i], 1.0F);
  }
}

// How often the instances of a scene are drawn in an area, by the runs that reach it.
std::uint32_t drawnIn(const TileRuns& runs, const VitrailRect& area) {
  std::uint32_t count = 0;
  for (const SurfaceRun& run : runs.touching(area)) count += run.instanceCount;
  return count;
}

class TileRunsTest : public GpuTest {
 protected:
  static TileRuns runsOf(const Scene& scene, const View& view) {
    const SceneDraws draws(scene, std::nullopt, DrawOrder::Forward, UINT32_MAX);
    SurfaceList surfaces(draws, scene, 0);
    surfaces.setView(makeFrameData(view, kTiledSide, kTiledSide, draws.origin()));
    return TileRuns(surfaces, kTiledSide, kTiledSide);
  }

  // In tiles of few pixels: the same bits, whatever the order.
  void expectSameBits(const Scene& scene, RenderOptions options, std::uint32_t leastTiles) {
    for (const DrawOrder order : {DrawOrder::Forward, DrawOrder::Reversed, DrawOrder::Shuffled}) {
      SCOPED_TRACE(static_cast<int>(order));
      StillRenderer renderer(gpu(), scene, {}, order, {});
      options.memoryBudget.reset();
      const RenderResult whole = renderer.render(options);
      EXPECT_EQ(whole.report.tiles, 1U);
      for (const std::uint64_t budget : {1U << 16U, 1U << 18U}) {
        options.memoryBudget = budget;
        const RenderResult tiled = renderer.render(options);
        EXPECT_TRUE(tiled.picture.rgba == whole.picture.rgba) << budget;
        EXPECT_EQ(tiled.report.fragmentsStored, whole.report.fragmentsStored) << budget;
        EXPECT_GE(tiled.report.tiles, budget < (1U << 17U) ? leastTiles : 1U) << budget;
      }
    }
  }
};

TEST_F(TileRunsTest, InstancesAreDrawnWhereTheyAre) {
  Scene scene;
  addInstances(scene, {{-0.5F, 0.5F, 0.0F}, {0.5F, 0.5F, 0.0F}, {-0.5F, -0.5F, 0.0F}, {0.6F, 0.5F, 0.0F}});
  const TileRuns runs = runsOf(scene, straightView());
  EXPECT_EQ(drawnIn(runs, {0, 0, kTiledSide, kTiledSide}), 4U);
  EXPECT_EQ(runs.touching({0, 0, kTiledSide, kTiledSide}).size(), 1U) << "instances that follow each other are one run";
  EXPECT_EQ(drawnIn(runs, {0, 0, 50, 50}), 1U) << "upper left";
  EXPECT_EQ(drawnIn(runs, {50, 0, 50, 50}), 2U) << "upper right";
  EXPECT_EQ(runs.touching({50, 0, 50, 50}).size(), 2U) << "they do not follow each other";
  EXPECT_EQ(drawnIn(runs, {0, 50, 50, 50}), 1U) << "lower left";
  EXPECT_EQ(drawnIn(runs, {50, 50, 50, 50}), 0U) << "lower right";
  // The first square has the pixels 20 to 29 of both axes.
  EXPECT_EQ(drawnIn(runs, {0, 0, 20, 20}), 1U) << "a tile that it touches";
  EXPECT_EQ(drawnIn(runs, {0, 0, 15, 15}), 0U);
}

TEST_F(TileRunsTest, WhatReachesBehindTheEyeIsDrawnInEveryTile) {
  Scene scene;
  addRectangle(scene, {glm::vec2(-0.1F), glm::vec2(0.1F), 0.0F}, unlitMaterial({0.2F, 0.4F, 0.6F, 0.5F}));
  scene.draws[0].transform = glm::mat4(1.0F);
  scene.draws[0].transform[0] = glm::vec4(0.0F, 0.0F, 50.0F, 0.0F); // its plane holds the view's axis
  const TileRuns runs = runsOf(scene, reference::wideView());
  EXPECT_EQ(drawnIn(runs, {0, 0, 1, 1}), 1U);
  EXPECT_EQ(drawnIn(runs, {99, 99, 1, 1}), 1U);
}

TEST_F(TileRunsTest, ScenesOfManyObjectsAreTheSameInEveryOrder) {
  for (const std::string name : {"mannequins", "spheres"}) {
    if (name == "spheres" && !tests::isThorough()) continue;
    SCOPED_TRACE(name);
    const Scene scene = makeBuiltinScene(name, {});
    expectSameBits(scene, usualOptions(scene, 160, 90), 8);
  }
}

// From among the objects, some of which are on both sides of the eye's plane.
TEST_F(TileRunsTest, SoAreTheySeenFromWithin) {
  Scene scene;
  std::vector<glm::vec3> places;
  for (int i = 0; i < 60; ++i) {
    const auto t = static_cast<float>(i);
    places.emplace_back(std::sin(t), std::cos(1.7F * t), 1.0F - 0.1F * t);
  }
  addInstances(scene, places);
  for (std::size_t i = 0; i < scene.draws.size(); i += 2) { // long ones, along the view
    scene.draws[i].transform[0] = glm::vec4(0.3F, 0.0F, 40.0F, 0.0F);
  }
  RenderOptions options;
  options.width = options.height = 128;
  options.view = reference::wideView();
  expectSameBits(scene, options, 4);
}

// Points reach beyond the boxes around their positions.
TEST_F(TileRunsTest, LargePointsAreWholeInTiles) {
  Scene scene;
  scene.pointSize = 40.0F;
  Mesh mesh;
  mesh.primitive = Primitive::Points;
  for (int i = 0; i < 24; ++i) {
    const auto t = static_cast<float>(i);
    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.emplace_back(0.5F * std::sin(t), 0.5F * std::cos(2.3F * t), 0.1F * t);
  }
  scene.meshes.push_back(mesh);
  scene.materials.push_back(unlitMaterial({1.0F, 0.2F, 0.0F, 0.3F}));
  scene.draws.emplace_back();
  RenderOptions options;
  options.width = options.height = 128;
  options.view = straightView();
  expectSameBits(scene, options, 2);
}

} // namespace
} // namespace vitrail::tool::test
