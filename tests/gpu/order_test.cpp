// The same scene gives the same bits: in any order of submission, from run to run, and from renderer to renderer.
#include <string>
#include <vector>

#include "../../tool/scene/builtin.h"
#include "gpu_fixture.h"

namespace vitrail::tool::test {
namespace {

constexpr std::uint32_t kWidth = 320;
constexpr std::uint32_t kHeight = 180;

// Fewer tubes than usual keep the hairball quick; its lists are still deep.
Scene sceneOf(const std::string& name) {
  BuiltinOptions options;
  if (name == "hairball") options.count = 1000;
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
  const RenderOptions options = usualOptions(scene, kWidth, kHeight);
  const RenderResult forward = renderOnce(gpu(), scene, options, {}, DrawOrder::Forward);
  EXPECT_TRUE(forward.report.exact);
  EXPECT_GT(forward.report.layersMax, 2U); // else there is nothing to sort
  const RenderResult reversed = renderOnce(gpu(), scene, options, {}, DrawOrder::Reversed);
  EXPECT_TRUE(reversed.picture.rgba == forward.picture.rgba);
  const RenderResult shuffled = renderOnce(gpu(), scene, options, {}, DrawOrder::Shuffled);
  EXPECT_TRUE(shuffled.picture.rgba == forward.picture.rgba);
}

TEST_P(OrderTest, TenRunsAreOne) {
  const Scene scene = sceneOf(GetParam());
  const RenderOptions options = usualOptions(scene, kWidth, kHeight);
  Renderer renderer(gpu(), scene);
  const RenderResult first = renderer.render(options);
  for (int run = 1; run < 5; ++run) {
    EXPECT_TRUE(renderer.render(options).picture.rgba == first.picture.rgba) << "run " << run;
  }
  for (int run = 5; run < 10; ++run) {
    EXPECT_TRUE(renderOnce(gpu(), scene, options).picture.rgba == first.picture.rgba) << "run " << run;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, OrderTest, ::testing::ValuesIn(sceneNames()),
                         [](const auto& scene) { return scene.param; });

} // namespace
} // namespace vitrail::tool::test
