// The hook that takes sorted lists: what it is told, and that what it makes of it is what is drawn.
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <string>

#include "reference.h"

namespace vitrail::tests::raster {
namespace {

struct PixelList {
  std::vector<VitrailLayer> layers;
  std::vector<float> behind; // 4 times samples
};

struct Lists {
  std::uint32_t samples = 1;
  std::mutex mutex;
  std::map<std::pair<std::uint32_t, std::uint32_t>, PixelList> pixels;
  std::uint32_t twice = 0; // pixels of which the hook was told more than once
};

int keep(void* user, std::uint32_t x, std::uint32_t y, const VitrailLayer* layers, std::uint32_t count, float* color) {
  Lists& lists = *static_cast<Lists*>(user);
  const std::lock_guard lock(lists.mutex);
  const auto [place, isNew] = lists.pixels.try_emplace({x, y});
  lists.twice += static_cast<std::uint32_t>(!isNew);
  place->second = {{layers, layers + count}, {color, color + std::size_t{4} * lists.samples}};
  return 0;
}

Color blended(const PixelList& list, std::uint32_t samples) {
  Color mean{};
  for (std::uint32_t s = 0; s < samples; ++s) {
    Blended all;
    for (const VitrailLayer& layer : list.layers) {
      if ((layer.coverage >> s & 1U) == 0) continue;
      Fragment fragment;
      for (std::size_t c = 0; c < 4; ++c) fragment.color[c] = double{layer.color[c]};
      fragment.blend = layer.blend;
      all = compose(all, blendOf(fragment));
    }
    Color behind{};
    for (std::size_t c = 0; c < 4; ++c) behind[c] = double{list.behind[4 * s + c]};
    const Color color = over(all, behind);
    for (std::size_t c = 0; c < 4; ++c) mean[c] += color[c] / samples;
  }
  return mean;
}

class ListTest : public testing::TestWithParam<std::uint32_t> {
 protected:
  ListTest() {
    Random random(60 + GetParam());
    options.samples = GetParam();
    options.hasFilters = options.hasDiscards = options.hasOpaque = options.hasOtherTopologies = true;
    options.hasSampleColors = GetParam() > 1;
    scene = randomScene(random, options);
    for (std::uint32_t i = 0; i < scene.draws.size(); ++i) scene.draws[i]->desc.word = 1000 + i;
    scene.frame.pictureWidth = options.width + 20;
    scene.frame.pictureHeight = options.height + 30;
    scene.frame.originX = 7;
    scene.frame.originY = 11;
  }

  SceneOptions options;
  Scene scene;
};

INSTANTIATE_TEST_SUITE_P(Samples, ListTest, testing::Values(1U, 2U, 4U, 8U),
                         [](const auto& given) { return std::to_string(given.param); });

TEST_P(ListTest, HoldsWhatIsBlended) {
  const Expected expected = expectedOf(scene);
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    for (const std::uint64_t budget : {0ULL, 65536ULL}) {
      Raster raster(instructions, 3);
      Lists lists;
      lists.samples = options.samples;
      scene.frame.list = keep;
      scene.frame.listUser = &lists;
      const Drawn drawn = draw(raster, scene, budget);
      EXPECT_EQ(lists.twice, 0U);
      EXPECT_EQ(lists.pixels.size(), drawn.stats.coveredPixels);
      for (const auto& [place, list] : lists.pixels) {
        const std::size_t pixel = std::size_t{place.second - 11} * options.width + (place.first - 7);
        ASSERT_LT(pixel, expected.pixels.size());
        const Color color = blended(list, options.samples);
        for (std::size_t c = 0; c < 4; ++c) ASSERT_NEAR(drawn.pixels[4 * pixel + c], color[c], 2e-5);
        std::size_t fragments = 0;
        for (std::size_t i = 0; i < list.layers.size(); ++i) {
          const VitrailLayer& layer = list.layers[i];
          ASSERT_LE(list.layers[i == 0 ? 0 : i - 1].depth, layer.depth);
          ASSERT_LT(layer.word - 1000, scene.draws.size());
          ASSERT_TRUE(layer.coverage != 0 && layer.coverage < 1U << options.samples);
          // A filter is a second layer of its fragment.
          const VitrailCpuDraw& desc = scene.draws[layer.word - 1000]->desc;
          fragments += static_cast<std::size_t>(layer.blend == static_cast<std::uint32_t>(desc.blend));
        }
        ASSERT_TRUE(expected.isUndecided[pixel] || fragments == expected.layers[pixel]);
      }
    }
  }
}

TEST_P(ListTest, IsBlendedByTheHost) {
  Raster raster(VITRAIL_CPU_BEST, 3);
  scene.frame.list = nullptr;
  const Drawn plain = draw(raster, scene);
  // Every second pixel becomes the number of its layers, in the first sample only.
  scene.frame.list = [](void* user, std::uint32_t x, std::uint32_t y, const VitrailLayer*, std::uint32_t count,
                        float* color) {
    if ((x + y) % 2 == 0) return 0;
    std::fill_n(color, std::size_t{4} * *static_cast<std::uint32_t*>(user), 0.0F);
    color[0] = static_cast<float>(count);
    return 1;
  };
  scene.frame.listUser = &options.samples;
  const Drawn drawn = draw(raster, scene);
  std::size_t own = 0;
  for (std::uint32_t y = 0; y < options.height; ++y) {
    for (std::uint32_t x = 0; x < options.width; ++x) {
      const float* a = &drawn.pixels[(std::size_t{y} * options.width + x) * 4];
      const float* b = &plain.pixels[(std::size_t{y} * options.width + x) * 4];
      if (a[3] == 0.0F) { // the host's: nothing else is without alpha
        ++own;
        ASSERT_EQ((x + 7 + y + 11) % 2, 1U);
        const float count = a[0] * static_cast<float>(options.samples);
        ASSERT_TRUE(count >= 1.0F && count == std::floor(count)) << count;
        continue;
      }
      for (std::size_t c = 0; c < 4; ++c) ASSERT_NEAR(a[c], b[c], 2e-5); // but for what little light hides
    }
  }
  EXPECT_NEAR(static_cast<double>(own), plain.stats.coveredPixels / 2.0, plain.stats.coveredPixels / 8.0);
}

// Draws that do the same at one depth come to the hook in an order of their own, too.
TEST(ListOrderTest, OfEqualFragmentsDoesNotDependOnThatOfDraws) {
  for (const std::uint32_t samples : {1U, 4U}) {
    const std::vector<Position> triangle = {
        {-1.0F, -1.0F, 0.5F, 1.0F}, {3.0F, -1.0F, 0.5F, 1.0F}, {-1.0F, 3.0F, 0.5F, 1.0F}};
    std::vector<VitrailCpuDraw> draws(5, drawOf(triangle));
    for (std::uint32_t i = 0; i < draws.size(); ++i) {
      std::fill_n(draws[i].color, 4, 0.5F);
      draws[i].word = 5 - i;
      if (i % 2 == 0) continue; // of the same light
      draws[i].blend = VITRAIL_BLEND_PREMULTIPLIED;
      std::fill_n(draws[i].color, 3, 0.25F);
    }
    Raster raster;
    const auto wordsOf = [&] {
      std::vector<std::uint32_t> words;
      Picture picture(1, 1);
      VitrailCpuFrame frame = picture.frame();
      frame.samples = samples;
      frame.list = [](void* user, std::uint32_t, std::uint32_t, const VitrailLayer* layers, std::uint32_t count,
                      float*) {
        for (std::uint32_t i = 0; i < count; ++i)
          static_cast<std::vector<std::uint32_t>*>(user)->push_back(layers[i].word);
        return 0;
      };
      frame.listUser = &words;
      EXPECT_EQ(raster.render(frame, draws), VITRAIL_SUCCESS);
      return words;
    };
    EXPECT_EQ(wordsOf(), (std::vector<std::uint32_t>{1, 3, 5, 2, 4})) << samples << " samples";
    std::reverse(draws.begin(), draws.end());
    EXPECT_EQ(wordsOf(), (std::vector<std::uint32_t>{1, 3, 5, 2, 4})) << samples << " samples, reversed";
  }
}

} // namespace
} // namespace vitrail::tests::raster
