// What the method stochastic promises beyond one surface in a pixel: the mean of its pictures is the exact one, and the
// deviation falls as 1 / sqrt(passes x samples).
#include <cmath>
#include <cstdint>
#include <string>

#include "../../tool/scene/builtin/builtin.h"
#include "../../tool/scene/srgb.h"
#include "../reference/test_scenes.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::straightView;

struct Error {
  double mean = 0.0;      // of the differences of linear colours
  double deviation = 0.0; // the root of the mean square
};

Error errorOf(const Picture& picture, const Picture& exact) {
  Error error;
  std::size_t count = 0;
  const auto linear = [](const Picture& of, std::size_t i) {
    return linearFromSrgb(glm::vec3(of.rgba[i], of.rgba[i + 1], of.rgba[i + 2]) / 255.0F);
  };
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    if (picture.rgba[i + 3] != 255) continue;
    const glm::vec3 difference = linear(picture, i) - linear(exact, i);
    for (int c = 0; c < 3; ++c) {
      error.mean += static_cast<double>(difference[c]);
      error.deviation += static_cast<double>(difference[c] * difference[c]);
      ++count;
    }
  }
  error.mean /= static_cast<double>(count);
  error.deviation = std::sqrt(error.deviation / static_cast<double>(count));
  return error;
}

class StochasticTest : public GpuTest {
 protected:
  // Four times the passes, half the deviation.
  static void expectConvergence(const Scene& scene, const RenderOptions& picture, std::uint32_t samples) {
    SCOPED_TRACE(scene.name + ", " + std::to_string(samples) + " samples");
    MethodOptions exact;
    exact.nodes = VITRAIL_NODE_HDR;
    exact.samples = samples;
    const Picture right = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, exact).picture;
    MethodOptions method;
    method.name = "stochastic";
    method.samples = samples;
    Error last;
    for (const std::uint32_t passes : {4U, 16U, 64U}) {
      SCOPED_TRACE(std::to_string(passes) + " passes");
      method.passes = passes;
      const Error error = errorOf(renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, method).picture, right);
      EXPECT_GT(error.deviation, 0.0);
      EXPECT_LT(std::abs(error.mean), 0.1 * error.deviation) << error.deviation;
      if (passes > 4) {
        EXPECT_NEAR(error.deviation / last.deviation, 0.5, 0.07) << error.deviation;
      }
      last = error;
    }
  }
};

TEST_F(StochasticTest, ErrorFallsAsTheRootOfSamples) {
  BuiltinOptions options;
  options.count = 12;
  const Scene scene = makeBuiltinScene("planes", options);
  RenderOptions picture = usualOptions(scene, 64, 36);
  picture.background.srgb = glm::vec3(0.3F); // what is added to a white one is cut off
  expectConvergence(scene, picture, 1);
  if ((gpu().features().sampleCounts & 4U) != 0) expectConvergence(scene, picture, 4);
}

// Each channel of what lies behind tinted glass is hidden as often as the glass hides it.
TEST_F(StochasticTest, TintedGlassConverges) {
  Scene scene;
  scene.name = "tinted glass";
  for (int i = 0; i < 3; ++i) {
    const auto step = static_cast<float>(i);
    Material glass;
    glass.baseColor = {0.9F - 0.4F * step, 0.5F, 0.1F + 0.4F * step, 1.0F};
    glass.metallic = 0.0F;
    glass.roughness = 0.6F;
    glass.transmission = 0.9F - 0.2F * step;
    addRectangle(scene, {glm::vec2(-0.9F, -0.8F + 0.1F * step), glm::vec2(0.9F, 0.7F)}, glass);
    scene.draws.back().transform[3].z = 2.0F * static_cast<float>((i * 2) % 3);
  }
  RenderOptions picture = usualOptions(scene, 96, 64);
  picture.view = straightView();
  picture.background.srgb = glm::vec3(0.3F);
  expectConvergence(scene, picture, 1);
}

} // namespace
} // namespace vitrail::tool::test
