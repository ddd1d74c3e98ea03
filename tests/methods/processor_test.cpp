// The method `cpu` on every built-in scene: against the double-precision reference, against fragment lists on the
// Vulkan device, and against itself, whatever draws it and in whatever order.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "../../tool/cpu/cpu_scene.h"
#include "../../tool/image/encode.h"
#include "../../tool/methods/methods.h"
#include "../../tool/render/cpu_still.h"
#include "../../tool/render/rasterizer.h"
#include "../../tool/scene/builtin/builtin.h"
#include "../reference/compare.h"
#include "../reference/reference.h"
#include "../thorough.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::Comparison;
using reference::Reference;

constexpr int kProcessorBound = 1; // of 255

// With several samples surfaces are shaded at pixel centres that may lie far outside of a thin triangle, where its
// corners' rounding moves a colour by much: in so many pixels.
constexpr double kOutsideShare = 3e-4;

struct ProcessorCase {
  std::string scene;
  std::uint32_t count = 0; // 0: the scene's own
  // Pixels at which the reference may find another surface, as a share of the picture and for each sample: tubes have
  // their edges nearly everywhere.
  double edgeShare = 0.0;
  // Where devices round textures otherwise, and the last bit decides whether there is a fragment or nothing: the share
  // of pixels that may have other fragments than on the Vulkan device.
  double roundedShare = 0.0;
};

void PrintTo(const ProcessorCase& row, std::ostream* out) { *out << row.scene; }

MethodOptions processor(std::uint32_t samples = 1) {
  MethodOptions method;
  method.name = kCpuMethod;
  method.samples = samples;
  return method;
}

MethodOptions counting() {
  MethodOptions method;
  method.name = kLayerCount;
  return method;
}

class ProcessorTest : public GpuTest, public ::testing::WithParamInterface<ProcessorCase> {
 protected:
  static Scene scene() {
    BuiltinOptions options;
    if (GetParam().count > 0) options.count = GetParam().count;
    return makeBuiltinScene(GetParam().scene, options);
  }
  static Scene withoutMipmaps() {
    Scene result = scene();
    for (Material& material : result.materials) material.baseColorTexture.sampler.mipmaps = false;
    return result;
  }
  static RenderOptions picture(const Scene& scene) { return usualOptions(scene, 160, 88); }
  static RenderResult draw(const Scene& scene, const MethodOptions& method, DrawOrder order = DrawOrder::Forward,
                           std::optional<std::uint64_t> budget = {}) {
    RenderOptions options = picture(scene);
    options.memoryBudget = budget;
    return CpuStillRenderer(scene, {}, order, method).render(options);
  }
  // The largest difference of a channel, of each pixel.
  static std::vector<int> differences(const Picture& a, const Picture& b) {
    std::vector<int> result(a.rgba.size() / 4);
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
      result[i / 4] = std::max(result[i / 4], std::abs(int{a.rgba[i]} - b.rgba[i]));
    }
    return result;
  }
  static bool isBeyond(int difference) { return difference > kProcessorBound; }

  static std::size_t outside(const Reference& reference) {
    return static_cast<std::size_t>(kOutsideShare * static_cast<double>(reference.edge.size()));
  }

  // Each pixel has as many fragments as some ray near its middle meets; few rays are tried, so that some silhouettes
  // are missed.
  static void expectLayersOf(const Reference& expected, const Scene& scene) {
    const FrameReport counted = CpuStillRenderer(scene, {}, DrawOrder::Forward, counting()).measure(picture(scene));
    ASSERT_EQ(counted.pixelLayers.size(), expected.layerRanges.size());
    std::size_t others = 0;
    for (std::size_t i = 0; i < counted.pixelLayers.size(); ++i) {
      const auto [least, most] = expected.layerRanges[i];
      others += counted.pixelLayers[i] < least || counted.pixelLayers[i] > most;
    }
    EXPECT_LE(others, counted.pixelLayers.size() / 2000) << "pixels with fragments that no ray near them meets";
  }

  // The colours of fragment lists on the Vulkan device, but where the reference says that rounding decides.
  static void expectLikeVulkan(const Scene& scene, const Picture& drawn, std::uint32_t samples,
                               const Reference& expected) {
    MethodOptions lists;
    lists.samples = samples;
    const Picture there = renderOnce(gpu(), scene, picture(scene), {}, DrawOrder::Forward, lists).picture;
    const std::vector<int> difference = differences(drawn, there);
    std::size_t others = 0;
    for (std::size_t i = 0; i < difference.size(); ++i) {
      if (!isBeyond(difference[i]) || expected.edge[i] != 0) continue;
      ++others;
      RecordProperty("other_pixel", static_cast<int>(i));
    }
    EXPECT_LE(others, samples > 1 ? outside(expected) : 0) << "pixels away from edges differ from Vulkan's";
  }

  static Reference referenceOf(const Scene& scene, std::uint32_t samples) {
    const RenderOptions options = picture(scene);
    reference::ReferenceOptions same;
    same.width = options.width;
    same.height = options.height;
    same.view = options.view;
    same.background = options.background;
    same.samples = samples;
    same.nodeFormat = VITRAIL_NODE_HDR;
    return renderReference(scene, same);
  }
};

// The reference has no mipmaps: compared without them. Most scenes with as many samples as Mesa's driver has, if
// thorough all.
TEST_P(ProcessorTest, IsThatOfTheReference) {
  const Scene scene = withoutMipmaps();
  const bool every = GetParam().scene == "interlocked" || tests::isThorough();
  for (const std::uint32_t samples : {1U, 2U, 4U, 8U}) {
    if (samples != 1 && samples != 4 && !every) continue;
    SCOPED_TRACE(std::to_string(samples) + " samples");
    const Reference expected = referenceOf(scene, samples);
    const Picture drawn = draw(scene, processor(samples)).picture;
    const double share = GetParam().edgeShare * samples;
    const Comparison comparison = compare(drawn, expected.exact, expected, kProcessorBound);
    EXPECT_LE(comparison.beyond, samples > 1 ? outside(expected) : 0) << comparison;
    EXPECT_LE(comparison.edgeShare, share) << comparison;
    EXPECT_LE(comparison.edgeOver, 0.1 * share) << comparison;
    if (samples == 1) expectLayersOf(expected, scene);
    if ((gpu().features().sampleCounts & samples) != 0) expectLikeVulkan(scene, drawn, samples, expected);
  }
}

// Each pixel has the same fragments.
TEST_P(ProcessorTest, HasTheFragmentsOfVulkan) {
  const Scene made = scene();
  const RenderOptions options = picture(made);
  const FrameReport here = CpuStillRenderer(made, {}, DrawOrder::Forward, counting()).measure(options);
  const FrameReport there = StillRenderer(gpu(), made, {}, DrawOrder::Forward, counting()).measure(options);
  ASSERT_EQ(here.pixelLayers.size(), there.pixelLayers.size());
  std::size_t others = 0;
  for (std::size_t i = 0; i < here.pixelLayers.size(); ++i) others += here.pixelLayers[i] != there.pixelLayers[i];
  const auto pixels = static_cast<double>(here.pixelLayers.size());
  EXPECT_LE(static_cast<double>(others), GetParam().roundedShare * pixels) << "pixels with other fragments";
  const FrameReport drawn = draw(made, processor()).report;
  EXPECT_EQ(drawn.fragmentsRequested, here.fragmentsRequested);
  EXPECT_EQ(drawn.layersMax, here.layersMax);
  EXPECT_DOUBLE_EQ(drawn.layersMean, here.layersMean);
}

// With mipmaps, whose levels devices choose a little differently.
TEST_P(ProcessorTest, HasTheColoursOfVulkan) {
  const Scene made = scene();
  const RenderOptions options = picture(made);
  const Picture here = draw(made, processor()).picture;
  const Picture there = renderOnce(gpu(), made, options).picture;
  const std::size_t others = static_cast<std::size_t>(std::ranges::count_if(differences(here, there), isBeyond));
  RecordProperty("pixels", static_cast<int>(others));
  const auto pixels = static_cast<double>(here.rgba.size() / 4);
  EXPECT_LE(static_cast<double>(others), 0.1 * GetParam().edgeShare * pixels) << "pixels of another colour";
}

TEST_P(ProcessorTest, SubmissionOrderDoesNotMatter) {
  const Scene made = scene();
  for (const std::uint32_t samples : {1U, 4U}) {
    const RenderResult forward = draw(made, processor(samples));
    for (const DrawOrder order : {DrawOrder::Reversed, DrawOrder::Shuffled}) {
      const RenderResult other = draw(made, processor(samples), order);
      EXPECT_TRUE(other.picture.rgba == forward.picture.rgba) << samples << " samples";
      EXPECT_EQ(other.report.fragmentsRequested, forward.report.fragmentsRequested);
      EXPECT_EQ(other.report.layersMax, forward.report.layersMax);
    }
  }
}

TEST_P(ProcessorTest, NeitherDoThreadsNorMemory) {
  const Scene made = scene();
  const RenderOptions options = picture(made);
  std::vector<std::uint8_t> first;
  for (std::uint32_t threads = 1; threads <= 16; ++threads) {
    CpuScene drawn(made, {}, DrawOrder::Forward);
    Rasterizer rasterizer(threads);
    ASSERT_EQ(rasterizer.threads(), threads);
    for (const std::uint64_t budget : {std::uint64_t{0}, std::uint64_t{1} << 16U, std::uint64_t{1} << 20U}) {
      if (budget > 0 && threads != 1 && threads != 16) continue;
      std::vector<std::uint8_t> rgba(std::size_t{options.width} * options.height * 4, 255);
      VitrailCpuFrame frame{};
      frame.width = frame.pictureWidth = options.width;
      frame.height = frame.pictureHeight = options.height;
      frame.clipSpace = VITRAIL_CPU_CLIP_VULKAN;
      frame.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
      frame.colorFormat = VITRAIL_CPU_RGBA8_SRGB;
      frame.color = rgba.data();
      frame.memoryBudget = budget;
      VitrailStats stats{};
      rasterizer.render(frame, drawn.draws(options.view, options.width, options.height), &stats);
      EXPECT_EQ(stats.complete, 1U);
      if (first.empty()) first = rgba;
      EXPECT_TRUE(rgba == first) << threads << " threads, " << budget << " bytes";
    }
  }
}

std::vector<ProcessorCase> processorCases() {
  return {{.scene = "spheres", .edgeShare = 0.01},
          {.scene = "planes", .count = 12},
          {.scene = "interlocked", .edgeShare = 0.01},
          {.scene = "mannequins", .edgeShare = 0.05},
          {.scene = "hairball", .count = 1000, .edgeShare = 0.2},
          {.scene = "smoke", .edgeShare = 0.001, .roundedShare = 0.02},
          {.scene = "flames", .edgeShare = 0.001, .roundedShare = 0.02}};
}

INSTANTIATE_TEST_SUITE_P(Scenes, ProcessorTest, ::testing::ValuesIn(processorCases()),
                         [](const auto& scene) { return scene.param.scene; });

TEST(ProcessorCases, AreAllBuiltinScenes) {
  const std::vector<ProcessorCase> cases = processorCases();
  for (const BuiltinScene& scene : builtinScenes()) {
    EXPECT_EQ(std::ranges::count(cases, scene.name, &ProcessorCase::scene), 1) << scene.name;
  }
}

} // namespace
} // namespace vitrail::tool::test
