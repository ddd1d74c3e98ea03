// The same scene gives the same bits: in any order of submission, from run to run, and from renderer to renderer.
#include <cstdlib>
#include <string>
#include <vector>

#include "../../tool/scene/builtin/builtin.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

constexpr std::uint32_t kOrderWidth = 320;
constexpr std::uint32_t kOrderHeight = 180;

// Fewer tubes than usual keep the hairball quick; its lists are still deep.
Scene sceneOf(const std::string& name) {
  BuiltinOptions options;
  if (name == "hairball") options.count = 600;
  return makeBuiltinScene(name, options);
}

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtinScenes()) names.emplace_back(scene.name);
  return names;
}

class OrderTest : public GpuTest, public ::testing::WithParamInterface<std::string> {};

TEST_P(OrderTest, SubmissionOrderDoesNotMatter) {
  const Scene scene = sceneOf(GetParam());
  const RenderOptions options = usualOptions(scene, kOrderWidth, kOrderHeight);
  const RenderResult forward = renderOnce(gpu(), scene, options, {}, DrawOrder::Forward);
  EXPECT_TRUE(forward.report.complete);
  EXPECT_GT(forward.report.layersMax, 2U); // else there is nothing to sort
  const RenderResult reversed = renderOnce(gpu(), scene, options, {}, DrawOrder::Reversed);
  EXPECT_TRUE(reversed.picture.rgba == forward.picture.rgba);
  const RenderResult shuffled = renderOnce(gpu(), scene, options, {}, DrawOrder::Shuffled);
  EXPECT_TRUE(shuffled.picture.rgba == forward.picture.rgba);
}

TEST_P(OrderTest, RunsAreOne) {
  const Scene scene = sceneOf(GetParam());
  const RenderOptions options = usualOptions(scene, kOrderWidth, kOrderHeight);
  StillRenderer renderer(gpu(), scene);
  const RenderResult first = renderer.render(options);
  for (int run = 1; run < 5; ++run) {
    EXPECT_TRUE(renderer.render(options).picture.rgba == first.picture.rgba) << "run " << run;
  }
  EXPECT_TRUE(renderOnce(gpu(), scene, options).picture.rgba == first.picture.rgba) << "another renderer";
}

INSTANTIATE_TEST_SUITE_P(Scenes, OrderTest, ::testing::ValuesIn(sceneNames()),
                         [](const auto& scene) { return scene.param; });

class DrawnTest : public GpuTest, public ::testing::WithParamInterface<std::string> {};

// The other node formats, resolves and sample counts.
TEST_P(DrawnTest, SubmissionOrderDoesNotMatter) {
  const Scene scene = sceneOf(GetParam());
  const RenderOptions options = usualOptions(scene, kOrderWidth / 2, kOrderHeight / 2);
  for (const MethodOptions& method : methodVariety(gpu())) {
    SCOPED_TRACE(describe(method));
    const RenderResult forward = renderOnce(gpu(), scene, options, {}, DrawOrder::Forward, method);
    EXPECT_TRUE(forward.report.complete);
    const RenderResult shuffled = renderOnce(gpu(), scene, options, {}, DrawOrder::Shuffled, method);
    EXPECT_TRUE(shuffled.picture.rgba == forward.picture.rgba);
    EXPECT_EQ(shuffled.report.fragmentsStored, forward.report.fragmentsStored);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DrawnTest, ::testing::Values("interlocked", "hairball", "flames"),
                         [](const auto& scene) { return scene.param; });

// Hunts for races: VITRAIL_TEST_FRAMES frames of the deepest scene, bit for bit. By default only a few; a GPU makes a
// thousand in seconds.
TEST_F(GpuTest, ManyFramesOfTheHairballAreOne) {
  const char* wanted = std::getenv("VITRAIL_TEST_FRAMES");
  const int frames = wanted != nullptr ? std::atoi(wanted) : 3;
  ASSERT_GT(frames, 1) << "VITRAIL_TEST_FRAMES is a number of frames, at least 2";
  const Scene scene = makeBuiltinScene("hairball", {});
  const RenderOptions options = usualOptions(scene, kOrderWidth, kOrderHeight);
  StillRenderer renderer(gpu(), scene);
  const RenderResult first = renderer.render(options);
  EXPECT_TRUE(first.report.complete);
  for (int frame = 1; frame < frames; ++frame) {
    const RenderResult next = renderer.render(options);
    ASSERT_TRUE(next.picture.rgba == first.picture.rgba) << "frame " << frame;
    ASSERT_EQ(next.report.fragmentsStored, first.report.fragmentsStored) << "frame " << frame;
  }
}

} // namespace
} // namespace vitrail::tool::test
