// Pictures that are drawn without waiting for any are those of the still renderer, bit for bit, where they say that
// they are complete; the pool follows what they need, within the budget.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "../../tool/gpu/submit.h"
#include "../../tool/render/interactive.h"
#include "../../tool/scene/builtin/builtin.h"
#include "../reference/test_scenes.h"
#include "../thorough.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

class InteractiveTest : public GpuTest {
 protected:
  // A picture that is waited for, in the corner of images of that size.
  // Default size: that of the picture.
  static InteractivePicture drawAlone(InteractiveRenderer& renderer, const RenderOptions& options,
                                      VkExtent2D size = {}) {
    if (size.width == 0) size = {options.width, options.height};
    EXPECT_TRUE(renderer.draw(options, size, true));
    InteractivePicture picture = renderer.finish();
    EXPECT_EQ(renderer.pending(), 0U);
    return picture;
  }

  // Until one is complete: at most so many.
  static InteractivePicture drawComplete(InteractiveRenderer& renderer, const RenderOptions& options, int most,
                                         VkExtent2D size = {}) {
    for (int i = 1;; ++i) {
      InteractivePicture picture = drawAlone(renderer, options, size);
      if (picture.report.complete || i == most) return picture;
    }
  }

  static std::vector<RenderOptions> turned(const Scene& scene, std::uint32_t width, std::uint32_t height) {
    std::vector<RenderOptions> views;
    for (const float azimuth : {10.0F, 70.0F, 130.0F, 200.0F, 310.0F}) {
      views.push_back(usualOptions(scene, width, height));
      views.back().view =
          frameScene(scene, Orbit{azimuth, 20.0F, 1.0F}, static_cast<float>(width) / static_cast<float>(height));
    }
    return views;
  }
};

TEST_F(InteractiveTest, PicturesInFlightAreThoseOfTheStillRenderer) {
  const Scene scene = makeBuiltinScene("spheres", {16, 1});
  std::vector<RenderOptions> views = turned(scene, 96, 54);
  if (!tests::isThorough()) views.resize(3);
  for (const MethodOptions& method : methodVariety(gpu())) {
    if (!InteractiveRenderer::draws(method)) continue;
    SCOPED_TRACE(describe(method));
    InteractiveRenderer renderer(gpu(), scene, {}, method);
    for (const RenderOptions& view : views) drawComplete(renderer, view, 5); // the pool is large enough then
    StillRenderer still(gpu(), scene, {}, DrawOrder::Forward, method);
    std::size_t finished = 0;
    const auto finish = [&] {
      const InteractivePicture picture = renderer.finish();
      const RenderResult right = still.render(views[finished++]);
      EXPECT_TRUE(picture.pixels == right.picture.rgba) << "view " << finished;
      EXPECT_EQ(picture.report.complete, right.report.complete);
      EXPECT_EQ(picture.report.errorBound, right.report.errorBound);
      EXPECT_EQ(picture.report.fragmentsRequested, right.report.fragmentsRequested);
      EXPECT_EQ(picture.report.layersMax, right.report.layersMax);
      EXPECT_EQ(picture.report.resolve, right.report.resolve);
      EXPECT_GT(picture.report.frameMs, 0.0);
      EXPECT_EQ(picture.report.passesMs.front().first, "opaque");
    };
    for (const RenderOptions& view : views) {
      ASSERT_TRUE(renderer.draw(view, {96, 54}, true));
      if (renderer.pending() == InteractiveRenderer::kFramesInFlight) finish();
    }
    EXPECT_EQ(renderer.pending(), 1U);
    finish();
    EXPECT_TRUE(renderer.render(views[0]).picture.rgba == still.render(views[0]).picture.rgba);
  }
}

TEST_F(InteractiveTest, LightThatObjectsAbsorbFollowsTheView) {
  Scene scene = makeBuiltinScene("spheres", {12, 3});
  for (Material& material : scene.materials) {
    material.transmission = 1.0F;
    material.thickness = 1.0F;
    material.attenuationDistance = 0.5F;
    material.attenuationColor = {0.25F, 0.8F, 0.4F};
  }
  const std::vector<RenderOptions> views = turned(scene, 96, 64);
  InteractiveRenderer renderer(gpu(), scene, {}, {});
  ASSERT_TRUE(renderer.draw(views[0], {96, 64}, true));
  ASSERT_TRUE(renderer.draw(views[1], {96, 64}, true));
  StillRenderer still(gpu(), scene);
  for (const std::size_t i : {0U, 1U}) {
    const InteractivePicture picture = renderer.finish();
    EXPECT_TRUE(picture.report.complete);
    EXPECT_TRUE(picture.pixels == still.render(views[i]).picture.rgba) << i;
  }
}

// A part of larger images, of whatever size: nothing is made anew, and what is left of other pictures does not show.
TEST_F(InteractiveTest, APartOfTheImagesIsAPicture) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  for (const auto& [name, samples] : {std::pair{"linked-list", 1U}, {"linked-list", 4U}, {"tiles", 1U}}) {
    MethodOptions method;
    method.name = name;
    method.samples = samples;
    InteractiveRenderer renderer(gpu(), scene, {}, method);
    StillRenderer still(gpu(), scene, {}, DrawOrder::Forward, method);
    for (const auto& [width, height] : {std::pair{200U, 150U}, {66U, 50U}, {100U, 75U}, {50U, 37U}, {200U, 150U}}) {
      const RenderOptions options = usualOptions(scene, width, height);
      drawComplete(renderer, options, 5, {200, 150});
      ASSERT_TRUE(renderer.draw(options, {200, 150}, true));
      const InteractivePicture picture = renderer.finish();
      EXPECT_EQ(picture.image->info().extent.width, 200U);
      EXPECT_EQ(picture.part.width, width);
      EXPECT_TRUE(picture.pixels == still.render(options).picture.rgba)
          << width << " with " << samples << " by " << name;
    }
  }
}

// What windows sample is what is read back, in its corner.
TEST_F(InteractiveTest, TheImageHoldsThePixels) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  InteractiveRenderer renderer(gpu(), scene, {}, {});
  const RenderOptions options = usualOptions(scene, 60, 40);
  ASSERT_TRUE(renderer.draw(options, {100, 80}, true));
  const InteractivePicture held = renderer.finish();
  for (int i = 0; i < 4; ++i) { // others do not touch it
    ASSERT_TRUE(renderer.draw(usualOptions(scene, 100, 80), {100, 80}, false));
    EXPECT_NE(renderer.finish().image, held.image);
  }
  const GpuBuffer read(gpu(), 60 * 40 * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Readback, "read");
  Submitter(gpu()).run("read", [&](VkCommandBuffer commands) {
    cmdImageBarrier(commands, held.image->get(), held.image->range(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, 0}, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                    {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {60, 40, 1};
    vkCmdCopyImageToBuffer(commands, held.image->get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, read.get(), 1, &copy);
  });
  const auto* bytes = static_cast<const std::uint8_t*>(read.mapped());
  EXPECT_TRUE(held.pixels == std::vector<std::uint8_t>(bytes, bytes + 60 * 40 * 4));
}

TEST_F(InteractiveTest, ThePoolGrowsToWhatPicturesNeed) {
  const Scene scene = makeBuiltinScene("hairball", {});
  const RenderOptions options = usualOptions(scene, 160, 90);
  InteractiveRenderer renderer(gpu(), scene, {}, {});
  const InteractivePicture first = drawAlone(renderer, options);
  EXPECT_FALSE(first.report.complete);
  EXPECT_GT(first.report.fragmentsMissing, 0U);
  EXPECT_EQ(first.report.fragmentsStored, first.report.nodeCapacity);
  const InteractivePicture grown = drawComplete(renderer, options, 2);
  EXPECT_TRUE(grown.report.complete);
  EXPECT_GT(grown.report.nodeCapacity, first.report.nodeCapacity);
  EXPECT_TRUE(grown.pixels == renderOnce(gpu(), scene, options).picture.rgba);
}

TEST_F(InteractiveTest, AndNotBeyondTheBudget) {
  const Scene scene = makeBuiltinScene("hairball", {});
  RenderOptions options = usualOptions(scene, 160, 90);
  options.memoryBudget = 1 << 20U;
  InteractiveRenderer renderer(gpu(), scene, {}, {});
  const InteractivePicture picture = drawComplete(renderer, options, 5);
  EXPECT_FALSE(picture.report.complete);
  EXPECT_LE(picture.report.nodesBytes + picture.report.headsBytes, *options.memoryBudget);
  // What does not fit is drawn in tiles when it is waited for, and the other way again behind that.
  const RenderResult whole = renderer.render(options);
  EXPECT_GT(whole.report.tiles, 1U);
  EXPECT_TRUE(whole.report.complete);
  options.memoryBudget.reset();
  const InteractivePicture grown = drawComplete(renderer, options, 3);
  EXPECT_TRUE(grown.report.complete);
  EXPECT_TRUE(grown.pixels == whole.picture.rgba);
}

TEST_F(InteractiveTest, WithoutRoomForHeadsItIsLeftToTheStillRenderer) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  RenderOptions options = usualOptions(scene, 320, 240);
  options.memoryBudget = 64 << 10U;
  InteractiveRenderer renderer(gpu(), scene, {}, {});
  EXPECT_FALSE(renderer.draw(options, {320, 240}, true));
  EXPECT_EQ(renderer.pending(), 0U);
  EXPECT_TRUE(renderer.render(options).report.complete);
}

// A GPU always has the next frame: so many take less time in flight than one by one.
TEST_F(InteractiveTest, FramesInFlightTakeLessTimeOnAGpu) {
  if (gpu().properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) GTEST_SKIP() << "no GPU";
  constexpr int kCount = 200;
  const Scene scene = makeBuiltinScene("spheres", {});
  const auto viewOf = [&](int i) {
    RenderOptions options = usualOptions(scene, 1920, 1080);
    options.view = frameScene(scene, Orbit{static_cast<float>(i), 20.0F, 1.0F}, 16.0F / 9.0F);
    return options;
  };
  const auto time = [](const auto& draw) {
    for (int i = 0; i < 20; ++i) draw(i);
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kCount; ++i) draw(i);
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() / kCount;
  };
  InteractiveRenderer renderer(gpu(), scene, {}, {});
  double gpuTime = 0.0;
  const double inFlight = time([&](int i) {
    ASSERT_TRUE(renderer.draw(viewOf(i), {1920, 1080}, false));
    if (renderer.pending() == InteractiveRenderer::kFramesInFlight) gpuTime = renderer.finish().report.frameMs;
  });
  while (renderer.pending() > 0) renderer.finish();
  StillRenderer still(gpu(), scene);
  const double oneByOne = time([&](int i) { still.render(viewOf(i)); });
  std::printf("in flight %.3f ms a picture (GPU %.3f ms), one by one through the host %.3f ms\n", inFlight, gpuTime,
              oneByOne);
  EXPECT_LT(inFlight, oneByOne);
}

TEST_F(InteractiveTest, SizesChangeWhileFramesArePending) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  InteractiveRenderer renderer(gpu(), scene, {}, {});
  StillRenderer still(gpu(), scene);
  const auto expectNext = [&] {
    const InteractivePicture picture = renderer.finish();
    EXPECT_TRUE(picture.report.complete);
    const RenderOptions options = usualOptions(scene, picture.part.width, picture.part.height);
    EXPECT_TRUE(picture.pixels == still.render(options).picture.rgba) << picture.part.width;
  };
  for (const std::uint32_t side : {64U, 40U, 100U, 3U}) {
    if (renderer.pending() == InteractiveRenderer::kFramesInFlight) expectNext();
    ASSERT_TRUE(renderer.draw(usualOptions(scene, side, side), {side, side}, true));
  }
  while (renderer.pending() > 0) expectNext();
}

TEST_F(InteractiveTest, OpaqueScenesHaveNothingToCollect) {
  Scene scene;
  reference::addRectangle(scene, {}, reference::unlitMaterial({0.2F, 0.4F, 0.6F, 1.0F}, AlphaMode::Opaque));
  const RenderOptions options = usualOptions(scene, 32, 32);
  InteractiveRenderer renderer(gpu(), scene, {}, {});
  const InteractivePicture picture = drawAlone(renderer, options);
  EXPECT_TRUE(picture.report.complete);
  EXPECT_EQ(picture.report.fragmentsRequested, 0U);
  EXPECT_TRUE(picture.pixels == renderOnce(gpu(), scene, options).picture.rgba);
}

} // namespace
} // namespace vitrail::tool::test
