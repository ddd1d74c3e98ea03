// The fragments of each pixel that the method layer-count finds, against the reference's and against what fragment
// lists store.
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "../../tool/methods/methods.h"
#include "../../tool/render/cpu_still.h"
#include "../../tool/scene/builtin/builtin.h"
#include "../reference/reference.h"
#include "../reference/test_scenes.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::straightView;
using reference::unlitMaterial;

constexpr std::uint32_t kWidth = 66;
constexpr std::uint32_t kHeight = 44;

FrameReport countLayers(Gpu& gpu, const Scene& scene, const RenderOptions& options) {
  MethodOptions method;
  method.name = kLayerCount;
  return StillRenderer(gpu, scene, {}, DrawOrder::Forward, method).measure(options);
}

class LayerCountTest : public GpuTest {
 protected:
  void expectLikeReference(const std::string& name, std::optional<std::uint32_t> count = {}) {
    SCOPED_TRACE(name);
    BuiltinOptions builtin;
    builtin.count = count;
    const Scene scene = makeBuiltinScene(name, builtin);
    const RenderOptions options = usualOptions(scene, kWidth, kHeight);
    const FrameReport report = countLayers(gpu(), scene, options);
    reference::ReferenceOptions same;
    same.width = options.width;
    same.height = options.height;
    same.view = options.view;
    same.background = options.background;
    same.nodeFormat = VITRAIL_NODE_HDR;
    const reference::Reference expected = renderReference(scene, same);
    ASSERT_EQ(report.pixelLayers.size(), expected.layerRanges.size());
    for (std::size_t i = 0; i < report.pixelLayers.size(); ++i) {
      ASSERT_GE(report.pixelLayers[i], expected.layerRanges[i].least) << i % kWidth << ", " << i / kWidth;
      ASSERT_LE(report.pixelLayers[i], expected.layerRanges[i].most) << i % kWidth << ", " << i / kWidth;
    }
    MethodOptions lists;
    lists.nodes = VITRAIL_NODE_HDR;
    const FrameReport stored = renderOnce(gpu(), scene, options, {}, DrawOrder::Forward, lists).report;
    EXPECT_EQ(std::accumulate(report.pixelLayers.begin(), report.pixelLayers.end(), std::uint64_t{0}),
              stored.fragmentsStored);
    EXPECT_EQ(report.layersMax, stored.layersMax);
    EXPECT_DOUBLE_EQ(report.layersMean, stored.layersMean);

    // The processor counts as many, but where an edge passes through a pixel's centre to within its rounding.
    MethodOptions counting;
    counting.name = kLayerCount;
    const FrameReport onProcessor = CpuStillRenderer(scene, {}, DrawOrder::Forward, counting).measure(options);
    ASSERT_EQ(onProcessor.pixelLayers.size(), report.pixelLayers.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < report.pixelLayers.size(); ++i) {
      different += onProcessor.pixelLayers[i] != report.pixelLayers[i] ? 1 : 0;
    }
    EXPECT_LE(different, report.pixelLayers.size() / 200);
  }
};

TEST_F(LayerCountTest, BuiltinScenes) {
  expectLikeReference("interlocked");
  expectLikeReference("mannequins"); // among opaque surfaces
  expectLikeReference("planes", 300);
}

// Three panes, one behind an opaque wall, one that covers half of the picture, one that cannot be seen.
TEST_F(LayerCountTest, PanesByHand) {
  Scene scene;
  addRectangle(scene, {{-2.0F, -2.0F}, {2.0F, 2.0F}, -1.0F}, unlitMaterial({0.0F, 1.0F, 0.0F, 0.5F}));
  addRectangle(scene, {{-2.0F, -2.0F}, {2.0F, 0.0F}, 0.0F}, unlitMaterial({1.0F, 1.0F, 1.0F, 1.0F}, AlphaMode::Opaque));
  addRectangle(scene, {{-2.0F, -2.0F}, {0.0F, 2.0F}, 1.0F}, unlitMaterial({1.0F, 0.0F, 0.0F, 0.5F}));
  addRectangle(scene, {{-2.0F, -2.0F}, {2.0F, 2.0F}, 2.0F}, unlitMaterial({1.0F, 0.0F, 0.0F, 0.0F}));
  RenderOptions options;
  options.width = 8;
  options.height = 8;
  options.view = straightView();
  const FrameReport report = countLayers(gpu(), scene, options);
  ASSERT_EQ(report.pixelLayers.size(), 64U);
  for (std::size_t y = 0; y < 8; ++y) {
    for (std::size_t x = 0; x < 8; ++x) {
      const std::uint32_t expected = (x < 4 ? 1U : 0U) + (y < 4 ? 1U : 0U); // the wall is the lower half
      EXPECT_EQ(report.pixelLayers[y * 8 + x], expected) << x << ", " << y;
    }
  }
  EXPECT_EQ(report.layersMax, 2U);
  // Other sizes follow in the same renderer.
  MethodOptions method;
  method.name = kLayerCount;
  StillRenderer renderer(gpu(), scene, {}, DrawOrder::Forward, method);
  for (const std::uint32_t side : {4U, 16U}) {
    options.width = side;
    options.height = side;
    const FrameReport sized = renderer.measure(options);
    ASSERT_EQ(sized.pixelLayers.size(), std::size_t{side} * side);
    EXPECT_EQ(sized.fragmentsRequested, std::uint64_t{side} * side);
  }
}

// The processor draws large pictures in bands: what is counted belongs to the picture, not to the band.
TEST(LayerCountOnProcessor, CountsInEveryBand) {
  Scene scene;
  addRectangle(scene, {{-200.0F, -2.0F}, {200.0F, 0.0F}, 0.0F}, unlitMaterial({1.0F, 0.0F, 0.0F, 0.5F}));
  RenderOptions options;
  options.width = 32768;
  options.height = 520; // 512 rows fit in a band
  options.view = straightView();
  MethodOptions method;
  method.name = kLayerCount;
  const FrameReport report = CpuStillRenderer(scene, {}, DrawOrder::Forward, method).measure(options);
  EXPECT_EQ(report.tiles, 2U);
  ASSERT_EQ(report.pixelLayers.size(), std::size_t{options.width} * options.height);
  const std::size_t covered = report.pixelLayers.size() / 2; // the lower half
  EXPECT_EQ(std::count(report.pixelLayers.begin(), report.pixelLayers.end() - static_cast<std::ptrdiff_t>(covered), 0U),
            static_cast<std::ptrdiff_t>(covered));
  EXPECT_EQ(std::count(report.pixelLayers.begin(), report.pixelLayers.end(), 1U), static_cast<std::ptrdiff_t>(covered));
}

// No user chooses layer-count, which is not listed.
TEST(LayerCountOptions, WhatIsNotAskedForIsNotRefused) {
  MethodOptions method;
  method.name = kLayerCount;
  EXPECT_NO_THROW(checkPictureOptions(method, false, false));
}

} // namespace
} // namespace vitrail::tool::test
