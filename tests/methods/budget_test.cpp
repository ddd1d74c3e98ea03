// Pictures that do not fit: whole scenes under memory budgets, drawn in tiles, are bit-identical to the untiled ones;
// large pictures and pools work however small a device's bindings are.
#include <cstdint>
#include <string>

#include "../../tool/scene/builtin/builtin.h"
#include "../reference/test_scenes.h"
#include "../thorough.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::straightView;
using reference::unlitMaterial;

constexpr std::uint64_t kMebibyte = 1 << 20;
constexpr std::uint64_t kTooLittle = kMebibyte / 4; // for all of the scenes below

class BudgetTest : public GpuTest {
 protected:
  // Draws a scene without a budget and with ever larger ones, until one tile holds it: if thorough four times as large
  // each time, else sixteen times.
  void expectSameBits(const Scene& scene, const RenderOptions& options, const MethodOptions& method = {}) {
    SCOPED_TRACE(describe(method));
    StillRenderer renderer(gpu(), scene, {}, DrawOrder::Forward, method);
    const RenderResult whole = renderer.render(options);
    EXPECT_EQ(whole.report.tiles, 1U);
    std::uint32_t tiles = 2;
    for (std::uint64_t budget = kTooLittle; tiles > 1; budget *= tests::isThorough() ? 4 : 16) {
      RenderOptions bounded = options;
      bounded.memoryBudget = budget;
      const RenderResult result = renderer.render(bounded);
      EXPECT_TRUE(result.picture.rgba == whole.picture.rgba) << budget << " bytes";
      EXPECT_TRUE(result.report.complete) << budget << " bytes";
      EXPECT_EQ(result.report.fragmentsRequested, whole.report.fragmentsRequested) << budget << " bytes";
      EXPECT_EQ(result.report.layersMax, whole.report.layersMax) << budget << " bytes";
      EXPECT_LE(result.report.totalBytes, budget + 4096); // statistics come on top
      EXPECT_TRUE(budget > kTooLittle || result.report.tiles > 1);
      tiles = result.report.tiles;
      ASSERT_LT(budget, 4096 * kMebibyte);
    }
  }
};

TEST_F(BudgetTest, ScenesAreTheSameUnderEveryBudget) {
  for (const char* name : {"spheres", "mannequins", "smoke"}) {
    SCOPED_TRACE(name);
    const Scene scene = makeBuiltinScene(name, {});
    expectSameBits(scene, usualOptions(scene, 320, 180));
  }
}

TEST_F(BudgetTest, AndHoweverTheyAreDrawn) {
  const Scene scene = makeBuiltinScene("spheres", {});
  for (const MethodOptions& method : methodVariety(gpu())) expectSameBits(scene, usualOptions(scene, 160, 90), method);
}

TEST_F(BudgetTest, ThePoolGrowsWithinTheBudget) {
  const Scene scene = makeBuiltinScene("hairball", {});
  RenderOptions options = usualOptions(scene, 320, 180);
  StillRenderer renderer(gpu(), scene);
  const RenderResult whole = renderer.render(options);
  options.memoryBudget = 32 * kMebibyte;
  for (int i = 0; i < 2; ++i) { // the pool that was made for the first picture holds the second one
    const RenderResult bounded = renderer.render(options);
    EXPECT_TRUE(bounded.picture.rgba == whole.picture.rgba);
    EXPECT_TRUE(bounded.report.complete);
    EXPECT_EQ(bounded.report.tiles, 1U);
    EXPECT_GE(bounded.report.nodesBytes, 12 * whole.report.fragmentsRequested);
    EXPECT_GT(bounded.report.nodesBytes, 12ULL * 4 * 320 * 180); // more than it began with
    EXPECT_LE(bounded.report.totalBytes, *options.memoryBudget);
  }
}

// Panes that fill the picture, each of a colour of its own.
Scene panes(int count) {
  Scene scene;
  for (int i = 0; i < count; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(count);
    addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 4.0F - 8.0F * t},
                 unlitMaterial({t, 1.0F - t, 0.5F, 0.2F + 0.3F * t}));
  }
  return scene;
}

RenderOptions paneOptions(std::uint32_t width, std::uint32_t height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.view = straightView();
  return options;
}

// 8 million fragments, 100 MiB of nodes; if thorough four times as many.
TEST_F(BudgetTest, ALargePictureOfEightLayersIsDrawnInTiles) {
  const Scene scene = panes(8);
  const RenderResult small = renderOnce(gpu(), scene, paneOptions(4, 4));
  const std::uint32_t side = tests::isThorough() ? 2048 : 1024;
  RenderOptions options = paneOptions(2 * side, side / 2);
  options.memoryBudget = std::uint64_t{16} * side * side;
  const RenderResult large = renderOnce(gpu(), scene, options);
  EXPECT_TRUE(large.report.complete);
  EXPECT_GT(large.report.tiles, 4U);
  EXPECT_EQ(large.report.fragmentsStored, 8ULL * side * side);
  EXPECT_EQ(large.report.layersMax, 8U);
  std::size_t different = 0;
  for (std::size_t i = 0; i < large.picture.rgba.size(); ++i) {
    if (large.picture.rgba[i] != small.picture.rgba[i % 4]) ++different;
  }
  EXPECT_EQ(different, 0U);
}

// A pool beyond what one binding reaches on Mesa's CPU driver, 128 MiB, and beyond the threads that put its nodes on
// lists.
TEST_F(BudgetTest, APictureMayHaveMoreNodesThanABindingHolds) {
  MethodOptions method;
  method.listBuild = VITRAIL_LIST_BUILD_COMPUTE;
  const Scene scene = panes(4);
  const RenderResult small = renderOnce(gpu(), scene, paneOptions(4, 4), {}, DrawOrder::Forward, method);
  const RenderResult large = renderOnce(gpu(), scene, paneOptions(2048, 2048), {}, DrawOrder::Forward, method);
  EXPECT_TRUE(large.report.complete);
  EXPECT_EQ(large.report.fragmentsStored, 4ULL * 2048 * 2048);
  if (gpu().features().poolByAddress) {
    EXPECT_EQ(large.report.tiles, 1U);
    EXPECT_GE(large.report.nodesBytes, 12ULL * 4 * 2048 * 2048);
  }
  std::size_t different = 0;
  for (std::size_t i = 0; i < large.picture.rgba.size(); ++i) {
    if (large.picture.rgba[i] != small.picture.rgba[i % 4]) ++different;
  }
  EXPECT_EQ(different, 0U);
}

} // namespace
} // namespace vitrail::tool::test
