// Methods that keep the nearest layers of a pixel and sum up those beyond: the sums, and which layers are the nearest,
// do not depend on the order of submission, and all of these methods keep the same ones.
#include <string>
#include <vector>

#include "../../tool/methods/shared/layer_memory.h"
#include "../../tool/scene/builtin/builtin.h"
#include "../reference/test_scenes.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::straightView;
using reference::unlitMaterial;

class LayersTest : public GpuTest {
 protected:
  static RenderResult draw(const Scene& scene, const RenderOptions& picture, const std::string& name,
                           std::uint32_t layers, DrawOrder order = DrawOrder::Forward) {
    MethodOptions method;
    method.name = name;
    method.maxLayers = layers;
    return renderOnce(gpu(), scene, picture, {}, order, method);
  }

  // That this device has.
  static std::vector<std::string> methods() {
    std::vector<std::string> names = {"loop"};
    if (gpu().features().int64Atomics) names.emplace_back("loop-64");
    if (gpu().features().fragmentInterlock) names.emplace_back("interlock");
    return names;
  }

  static void expectOnePicture(const Scene& scene, const RenderOptions& picture, std::uint32_t layers) {
    const RenderResult first = draw(scene, picture, "loop", layers);
    EXPECT_FALSE(first.report.complete);
    EXPECT_GT(first.report.approximatePixels, 0U);
    for (const std::string& name : methods()) {
      for (const DrawOrder order : {DrawOrder::Forward, DrawOrder::Reversed, DrawOrder::Shuffled}) {
        const RenderResult result = draw(scene, picture, name, layers, order);
        EXPECT_TRUE(result.picture.rgba == first.picture.rgba) << name;
        EXPECT_EQ(result.report.approximatePixels, first.report.approximatePixels) << name;
      }
    }
  }
};

TEST_F(LayersTest, FragmentsBeyondTheNearestAreOrderFree) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  expectOnePicture(scene, usualOptions(scene, 96, 54), 2);
}

// Seven panes at one depth, of which three are kept, and tinted glass behind them.
TEST_F(LayersTest, EqualDepthsAreOrderFree) {
  Scene scene;
  for (int i = 0; i < 7; ++i) {
    const auto step = static_cast<float>(i);
    addRectangle(scene, {glm::vec2(-0.9F + 0.1F * step, -0.8F), glm::vec2(0.9F, 0.8F - 0.1F * step), 1.0F},
                 unlitMaterial({0.1F * step, 0.9F - 0.1F * step, 0.5F, 0.2F + 0.1F * step}));
  }
  Material glass;
  glass.baseColor = {0.3F, 0.9F, 0.5F, 1.0F};
  glass.metallic = 0.0F;
  glass.transmission = 0.8F;
  addRectangle(scene, {glm::vec2(-1.0F), glm::vec2(1.0F), -2.0F}, glass);
  RenderOptions picture = usualOptions(scene, 64, 48);
  picture.view = straightView();
  expectOnePicture(scene, picture, 3);
}

// The layers that methods count are those of the lists.
TEST_F(LayersTest, LayersAreCounted) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  const RenderOptions picture = usualOptions(scene, 96, 54);
  const FrameReport exact = renderOnce(gpu(), scene, picture).report;
  for (const std::string& name : methods()) {
    const FrameReport report = draw(scene, picture, name, 2).report;
    EXPECT_EQ(report.fragmentsRequested, exact.fragmentsRequested) << name;
    EXPECT_EQ(report.layersMax, exact.layersMax) << name;
    EXPECT_NEAR(report.layersMean, exact.layersMean, 1e-9) << name;
  }
}

// 858,993,460 layers of five words, or 2^31 and more of two, have few words in 32 bits.
TEST_F(LayersTest, TooManyLayersAreRefused) {
  const Scene scene = makeBuiltinScene("planes", {});
  std::vector<std::string> names = methods();
  if (gpu().features().fragmentInterlock) names.emplace_back("multi-layer");
  for (const std::string& name : names) {
    for (const std::uint32_t layers : {1U << 20U, 858'993'460U, 1U << 31U, UINT32_MAX}) {
      SCOPED_TRACE(name + ", " + std::to_string(layers) + " layers");
      try {
        draw(scene, usualOptions(scene, 64, 64), name, layers);
        ADD_FAILURE() << "32 GiB and more were found";
      } catch (const GpuError& error) {
        const std::string reason = error.what();
        EXPECT_NE(reason.find(name), std::string::npos) << reason;
        EXPECT_NE(reason.find("--layers"), std::string::npos) << reason;
        EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
      }
    }
  }
}

// The memory of a picture may have more bytes than 64 bits count: these have 2^64, and 2^64 + 2^48.
TEST_F(LayersTest, MoreMemoryThanCanBeCountedIsRefused) {
  for (const std::uint32_t height : {1U << 16U, (1U << 16U) + 1U}) {
    try {
      makeLayerMemory(gpu(), {1U << 16U, height}, {"loop", 1U << 29U, std::uint64_t{1} << 30U});
      ADD_FAILURE() << "more than 2^64 bytes were found";
    } catch (const GpuError& error) {
      EXPECT_NE(std::string(error.what()).find("17592"), std::string::npos) << error.what(); // 2^44 MiB
    }
  }
}

// Devices without interlock say so, and nothing is drawn without it.
TEST_F(LayersTest, InterlockIsRequired) {
  if (gpu().features().fragmentInterlock) GTEST_SKIP() << "the device has it";
  const Scene scene = makeBuiltinScene("planes", {});
  for (const std::string name : {"interlock", "multi-layer"}) {
    try {
      draw(scene, usualOptions(scene, 16, 16), name, 0);
      ADD_FAILURE() << name << " draws";
    } catch (const GpuError& error) {
      const std::string reason = error.what();
      EXPECT_NE(reason.find(name), std::string::npos) << reason;
      EXPECT_NE(reason.find("fragment shader interlock"), std::string::npos) << reason;
      EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
    }
  }
}

} // namespace
} // namespace vitrail::tool::test
