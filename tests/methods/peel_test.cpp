// Pictures of linked-list that lack the nearest surfaces are those of the rasteriser for CPUs; those whose lists are
// not sorted are blended as the surfaces arrived.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "../../tool/render/interactive.h"
#include "../../tool/scene/builtin/builtin.h"
#include "../reference/test_scenes.h"
#include "../thorough.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

class PeelTest : public GpuTest {
 protected:
  static MethodOptions processor(std::uint32_t samples) {
    MethodOptions method;
    method.name = "cpu";
    method.samples = samples;
    return method;
  }

  // How many channels differ by more than 2.
  static std::size_t off(const Picture& a, const Picture& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) count += std::abs(int{a.rgba[i]} - int{b.rgba[i]}) > 2 ? 1 : 0;
    return count;
  }
};

// Where surfaces cross, and at edges, a pixel may have another order or surface.
TEST_F(PeelTest, LeavesOutWhatTheProcessorLeavesOut) {
  for (const char* name : {"interlocked", "mannequins"}) {
    const Scene scene = makeBuiltinScene(name, {});
    const std::uint32_t samples = name == std::string("interlocked") ? 4U : 1U;
    MethodOptions method;
    method.samples = samples;
    StillRenderer renderer(gpu(), scene, {}, DrawOrder::Forward, method);
    const std::unique_ptr<Renderer> processor =
        rendererOf(gpu(), scene, {}, DrawOrder::Forward, this->processor(samples));
    RenderOptions options = usualOptions(scene, 120, 90);
    const Picture all = renderer.render(options).picture;
    for (const std::uint32_t peel : {1U, 4U}) {
      SCOPED_TRACE(std::string(name) + ", " + std::to_string(peel) + " of " + std::to_string(samples) + " samples");
      options.peel = peel;
      const RenderResult peeled = renderer.render(options);
      EXPECT_EQ(peeled.report.peeled, peel);
      EXPECT_TRUE(peeled.report.complete);
      EXPECT_GT(off(peeled.picture, all), 1000U);
      EXPECT_LT(off(peeled.picture, processor->render(options).picture), all.rgba.size() / 500);
      RenderOptions bounded = options;
      bounded.memoryBudget = 96 << 10U;
      const RenderResult tiles = renderer.render(bounded);
      EXPECT_GT(tiles.report.tiles, 1U);
      EXPECT_TRUE(tiles.picture.rgba == peeled.picture.rgba);
    }
    options.peel = 0;
    EXPECT_TRUE(renderer.render(options).picture.rgba == all.rgba);
  }
}

// A surface of glass is one, though it has two fragments.
TEST_F(PeelTest, AGlassIsOneSurface) {
  Scene scene;
  Material glass = reference::unlitMaterial({0.3F, 0.6F, 0.9F, 1.0F});
  glass.alphaMode = AlphaMode::Opaque;
  glass.unlit = false;
  glass.metallic = 0.0F;
  glass.transmission = 0.8F;
  reference::addRectangle(scene, {{-2.0F, -2.0F}, {2.0F, 2.0F}, 1.0F}, glass);
  reference::addRectangle(scene, {{-2.0F, -2.0F}, {2.0F, 2.0F}, 0.0F},
                          reference::unlitMaterial({0.9F, 0.1F, 0.1F, 0.5F}));
  RenderOptions options;
  options.width = options.height = 8;
  options.view = reference::straightView();
  options.peel = 1;
  const RenderResult peeled = renderOnce(gpu(), scene, options);
  EXPECT_EQ(peeled.report.fragmentsRequested, 3U * 64U);
  scene.draws.erase(scene.draws.begin());
  options.peel = 0;
  EXPECT_LE(largestDifference(peeled.picture, renderOnce(gpu(), scene, options).picture), 1);
}

TEST_F(PeelTest, SaysThatThereWasNothingToPeel) {
  Scene scene;
  reference::addRectangle(scene, {}, reference::unlitMaterial({0.5F, 0.5F, 0.5F, 1.0F}, AlphaMode::Opaque));
  RenderOptions options = usualOptions(scene, 8, 8);
  options.peel = 1;
  const std::vector<std::string> warnings = renderOnce(gpu(), scene, options).report.warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("nothing was peeled"), std::string::npos);
}

// In flight, from picture to picture: nothing is made anew, and the bits are those of the still renderer.
TEST_F(PeelTest, PicturesInFlightLackTheSame) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  InteractiveRenderer renderer(gpu(), scene, {}, {});
  StillRenderer still(gpu(), scene);
  RenderOptions options = usualOptions(scene, 160, 120);
  for (const std::uint32_t peel : {0U, 2U, 5U, 1U, 0U}) {
    options.peel = peel;
    ASSERT_TRUE(renderer.draw(options, {160, 120}, true));
    const InteractivePicture picture = renderer.finish();
    EXPECT_EQ(picture.report.peeled, peel);
    EXPECT_TRUE(picture.report.complete);
    EXPECT_TRUE(picture.pixels == still.render(options).picture.rgba) << peel;
  }
}

// The order of arrival, which on one processor is that of drawing, and on a GPU nearly: short lists, and long ones,
// which were sorted.
TEST_F(PeelTest, WithoutSortingSurfacesAreBlendedAsTheyArrive) {
  for (const char* name : {"spheres", "hairball"}) {
    SCOPED_TRACE(name);
    BuiltinOptions fewer;
    if (name == std::string("hairball")) fewer.count = tests::isThorough() ? 1500 : 600;
    const Scene scene = makeBuiltinScene(name, fewer);
    const RenderOptions options = usualOptions(scene, 120, 90);
    const bool isCpu = gpu().properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    const std::uint32_t samples = name == std::string("spheres") ? 1U : 4U;
    MethodOptions unsorted;
    unsorted.name = "unsorted";
    unsorted.samples = samples;
    MethodOptions method;
    method.samples = samples;
    const Picture sorted = renderOnce(gpu(), scene, options, {}, DrawOrder::Forward, method).picture;
    for (const VitrailListBuild build : {VITRAIL_LIST_BUILD_FRAGMENT, VITRAIL_LIST_BUILD_COMPUTE}) {
      method.sorted = false;
      method.listBuild = build;
      const RenderResult arrived = renderOnce(gpu(), scene, options, {}, DrawOrder::Forward, method);
      EXPECT_FALSE(arrived.report.complete);
      EXPECT_GT(off(arrived.picture, sorted), 1000U);
      EXPECT_LT(off(arrived.picture, renderOnce(gpu(), scene, options, {}, DrawOrder::Forward, unsorted).picture),
                sorted.rgba.size() / (isCpu ? 500 : 50));
    }
  }
}

} // namespace
} // namespace vitrail::tool::test
