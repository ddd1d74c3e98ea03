// What vulkan_raster.h promises, where frames are unlike most: triangles that reach behind the eye, colours that are
// nearly one, backgrounds that are not opaque, clip space of many scales, very many surfaces at one depth, any budget.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "raster_host.h"

namespace vitrail::tests::vulkan {
namespace {

class RasterPromisesTest : public VulkanTest {};

struct Sheet {
  float depth = 0.5F;
  Vec4 color;
  VitrailBlend blend = VITRAIL_BLEND_OVER;
};

// Sheets over the picture, or over a part of it in its upper left corner, a draw of two triangles each.
RasterScene sheetsOf(const std::vector<Sheet>& sheets, const Vec4& behind, float part = 1.0F) {
  RasterScene scene;
  scene.behind = behind;
  scene.indices = {0, 1, 2, 1, 3, 2};
  for (const Sheet& sheet : sheets) {
    VitrailVkRasterDraw draw{};
    draw.count = 6;
    draw.instanceCount = 1;
    draw.vertexOffset = static_cast<std::int32_t>(scene.vertices.size());
    draw.vertexCount = 4;
    draw.blend = sheet.blend;
    draw.word = static_cast<std::uint32_t>(scene.colors.size());
    scene.draws.push_back(draw);
    scene.colors.push_back(sheet.color);
    const float end = 2.0F * part - 1.0F;
    for (const float y : {-1.0F, end}) {
      for (const float x : {-1.0F, end}) scene.vertices.push_back({x, y, sheet.depth, 1.0F});
    }
  }
  return scene;
}

// By hand, in double precision; of one depth the first is in front.
std::array<double, 4> sheetsBlended(std::vector<Sheet> sheets, const Vec4& behind) {
  std::ranges::stable_sort(sheets, {}, &Sheet::depth);
  std::array<double, 4> color{};
  std::array<double, 4> through{1.0, 1.0, 1.0, 1.0};
  const auto stored = [](double value, double most) { return value > 0.0 ? std::min(value, most) : 0.0; };
  for (const Sheet& sheet : sheets) {
    const double alpha = stored(sheet.color[3], 1.0);
    const bool hides = sheet.blend == VITRAIL_BLEND_OVER || sheet.blend == VITRAIL_BLEND_PREMULTIPLIED;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = stored(sheet.color.at(c), 65504.0);
      if (sheet.blend == VITRAIL_BLEND_PREMULTIPLIED) color.at(c) += through.at(c) * value;
      if (sheet.blend == VITRAIL_BLEND_OVER || sheet.blend == VITRAIL_BLEND_ADDITIVE) {
        color.at(c) += through.at(c) * alpha * value;
      }
      if (hides) through.at(c) *= 1.0 - alpha;
      if (sheet.blend == VITRAIL_BLEND_MULTIPLY) through.at(c) *= 1.0 - alpha + alpha * value;
    }
    if (hides) through[3] *= 1.0 - alpha;
  }
  for (std::size_t c = 0; c < 3; ++c) color.at(c) += through.at(c) * behind.at(c);
  color[3] = 1.0 - through[3] + through[3] * behind[3];
  return color;
}

void expectColor(const Vec4& found, const std::array<double, 4>& expected, double error) {
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_NEAR(found.at(c), expected.at(c), error * std::max(1.0, std::abs(expected.at(c)))) << "channel " << c;
  }
}

std::vector<std::uint32_t> oneAndSeveral() {
  std::vector<std::uint32_t> all{1};
  for (const std::uint32_t samples : backend().features().multisampled) all.push_back(samples);
  return all;
}

// ---- Depths

// Two triangles with corners in front of the eye and behind it, seen with perspective and no far plane.
class CrossingPair {
 public:
  CrossingPair(std::mt19937& random, VitrailDepthOrder order, double nearPlane, double width) {
    const auto unit = [&] { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); };
    scene_ = sheetsOf({{0.5F, {1.0F, 0.0F, 0.0F, 0.5F}}, {0.5F, {0.0F, 1.0F, 0.0F, 0.5F}}}, {0.0F, 0.0F, 0.0F, 1.0F});
    scene_.vertices.clear();
    scene_.indices = {0, 1, 2};
    for (std::size_t t = 0; t < 2; ++t) {
      scene_.draws[t].count = scene_.draws[t].vertexCount = 3;
      scene_.draws[t].vertexOffset = static_cast<std::int32_t>(3 * t);
      std::array<std::array<double, 3>, 3> p{}; // x, y, w of the corners
      for (auto& corner : p) {
        const Vec4 v{static_cast<float>(unit() * width), static_cast<float>(unit() * width), 0.0F,
                     static_cast<float>(unit())};
        corner = {v[0], v[1], v[3]};
        const double z = order == VITRAIL_DEPTH_NEAREST_IS_ONE ? nearPlane : corner[2] - nearPlane;
        scene_.vertices.push_back({v[0], v[1], static_cast<float>(z), v[3]});
      }
      // n . (x, y, w) = 1 on the triangle's plane, so n . (x / w, y / w, 1) = 1 / w.
      const std::array<double, 3> x{p[0][0], p[1][0], p[2][0]};
      const std::array<double, 3> y{p[0][1], p[1][1], p[2][1]};
      const std::array<double, 3> w{p[0][2], p[1][2], p[2][2]};
      const std::array<double, 3> one{1.0, 1.0, 1.0};
      const double all = volume(x, y, w);
      planes_.at(t) = {volume(one, y, w) / all, volume(x, one, w) / all, volume(x, y, one) / all};
    }
  }

  [[nodiscard]] const RasterScene& scene() const { return scene_; }

  // How much nearer the first is, in pixels from where they cross.
  [[nodiscard]] double nearer(double ndcX, double ndcY, std::uint32_t side) const {
    std::array<double, 3> d{};
    for (std::size_t k = 0; k < 3; ++k) d.at(k) = planes_[0].at(k) - planes_[1].at(k);
    return (d[0] * ndcX + d[1] * ndcY + d[2]) / (std::hypot(d[0], d[1]) * 2.0 / side);
  }

 private:
  static double volume(const std::array<double, 3>& u, const std::array<double, 3>& v, const std::array<double, 3>& w) {
    return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
  }

  RasterScene scene_;
  std::array<std::array<double, 3>, 2> planes_{};
};

// A clipped triangle has corners up to 32,766 pixels away. Its plane of depths, whose slopes have 24 bits, must not
// begin at one of them: depths would be off by up to as much as they are.
TEST_F(RasterPromisesTest, TrianglesThatReachBehindTheEyeAreSorted) {
  constexpr std::uint32_t kPixels = 64;
  for (const VitrailDepthOrder order : {VITRAIL_DEPTH_NEAREST_IS_ONE, VITRAIL_DEPTH_NEAREST_IS_ZERO}) {
    RasterHostDesc desc;
    desc.width = desc.height = kPixels;
    desc.depthOrder = order;
    RasterHost host(desc);
    // Depths near 1 have so many bits less.
    const double nearPlane = order == VITRAIL_DEPTH_NEAREST_IS_ONE ? 1e-4 : 2.6e-4;
    std::mt19937 random(9);
    std::uint32_t both = 0;
    double worst = 0.0;
    for (int i = 0; i < 150; ++i) {
      const std::array<double, 3> widths{1.0, 0.3, 0.1};
      const CrossingPair pair(random, order, nearPlane, widths.at(static_cast<std::size_t>(i) % 3));
      host.setScene(pair.scene());
      host.draw();
      for (std::uint32_t y = 0; y < kPixels; ++y) {
        for (std::uint32_t x = 0; x < kPixels; ++x) {
          const Vec4 color = host.at(x, y);
          if (color[0] == 0.0F || color[1] == 0.0F) continue;
          ++both;
          const double nearer = pair.nearer((x + 0.5) * 2.0 / kPixels - 1.0, (y + 0.5) * 2.0 / kPixels - 1.0, kPixels);
          if ((color[0] > color[1]) != (nearer > 0.0)) worst = std::max(worst, std::abs(nearer));
        }
      }
    }
    EXPECT_GT(both, 2500U);
    EXPECT_LT(worst, 0.1) << "pixels from where the triangles cross, order " << order;
  }
}

// Depths that differ by their last bits, of which keys hold less.
TEST_F(RasterPromisesTest, DepthsThatAreNearlyOne) {
  std::mt19937 random(5);
  const auto channel = [&] { return static_cast<float>(random() % 17) / 16.0F; };
  for (const std::uint32_t samples : oneAndSeveral()) {
    for (const VitrailDepthOrder order : {VITRAIL_DEPTH_NEAREST_IS_ONE, VITRAIL_DEPTH_NEAREST_IS_ZERO}) {
      if (samples > 1 && (samples == 4) != (order == VITRAIL_DEPTH_NEAREST_IS_ONE)) continue; // each needs pipelines
      RasterHostDesc desc;
      desc.samples = samples;
      desc.depthOrder = order;
      RasterHost host(desc);
      for (const std::uint32_t count : {9U, 33U, 300U}) {
        const bool nearestIsOne = order == VITRAIL_DEPTH_NEAREST_IS_ONE;
        std::vector<Sheet> inOrder;
        float depth = nearestIsOne ? 0.3F : 0.75F;
        for (std::uint32_t i = 0; i < count; ++i) {
          inOrder.push_back({depth, {channel(), channel(), 0.5F, count > 40 ? 0.01F : 0.125F}});
          depth = std::nextafter(depth, nearestIsOne ? 0.0F : 1.0F);
        }
        std::vector<Sheet> shuffled = inOrder;
        std::ranges::shuffle(shuffled, random);
        for (Sheet& sheet : inOrder) sheet.depth = 0.5F;
        const Vec4 behind{0.25F, 0.5F, 0.75F, 1.0F};
        host.setScene(sheetsOf(shuffled, behind, 0.5F));
        host.draw();
        SCOPED_TRACE(testing::Message() << samples << " samples, order " << order << ", " << count << " sheets");
        expectColor(host.at(3, 2), sheetsBlended(inOrder, behind), 3e-4);
      }
    }
  }
}

// More surfaces at one depth than colours decide: the order of the draws, by whatever passes they are blended.
TEST_F(RasterPromisesTest, ManySheetsAtOneDepth) {
  std::mt19937 random(5);
  const auto channel = [&] { return static_cast<float>(random() % 17) / 16.0F; };
  for (const std::uint32_t samples : oneAndSeveral()) {
    RasterHostDesc desc;
    desc.samples = samples;
    RasterHost host(desc);
    for (const std::uint32_t count : {33U, 65U, 129U, 2600U}) {
      if (count > 1000 && samples > 1) continue; // takes long
      std::vector<Sheet> sheets;
      for (std::uint32_t i = 0; i < count; ++i) {
        sheets.push_back({0.5F,
                          {channel(), channel(), channel(), count > 40 ? 0.01F : channel()},
                          static_cast<VitrailBlend>(random() % 4)});
      }
      sheets.push_back({0.25F, {1.0F, 0.5F, 0.25F, 0.25F}});
      sheets.push_back({0.75F, {0.25F, 0.5F, 1.0F, 0.25F}});
      const Vec4 behind{0.25F, 0.5F, 0.75F, 1.0F};
      host.setScene(sheetsOf(sheets, behind, 0.25F));
      host.draw();
      SCOPED_TRACE(testing::Message() << samples << " samples, " << count << " sheets");
      expectColor(host.at(3, 2), sheetsBlended(sheets, behind), 3e-4);
      expectColor(host.at(7, 0), sheetsBlended(sheets, behind), 3e-4); // where both halves are
    }
  }
}

// ---- The same bits

// At one depth colours are put in order as halves hold them, and so blended: else of those that are one half the order
// of the draws would decide.
TEST_F(RasterPromisesTest, ColoursThatAreNearlyOne) {
  const Sheet a{0.5F, {0.50001F, 0.25F, 0.125F, 0.5F}};
  const Sheet b{0.5F, {0.5F, 0.25003F, 0.125F, 0.500003F}};
  RasterHost host({});
  host.setScene(sheetsOf({a, b}, {0.0F, 0.0F, 0.0F, 1.0F}));
  const std::vector<float> first = host.draw();
  host.setScene(sheetsOf({b, a}, {0.0F, 0.0F, 0.0F, 1.0F}));
  EXPECT_TRUE(host.draw() == first);
}

// Surfaces of one colour and depth that cover unlike samples of a pixel: what they cover is a part of their order.
TEST_F(RasterPromisesTest, SamplesOfOneColour) {
  for (const std::uint32_t samples : backend().features().multisampled) {
    std::mt19937 random(8);
    const auto unit = [&] { return std::uniform_real_distribution<float>(-1.5F, 1.5F)(random); };
    RasterHostDesc desc;
    desc.samples = samples;
    RasterHost host(desc);
    RasterScene scene = sheetsOf(std::vector(14, Sheet{0.5F, {0.3F, 0.7F, 0.123F, 0.37F}}), {0.25F, 0.5F, 0.75F, 1.0F});
    scene.indices = {0, 1, 2};
    for (VitrailVkRasterDraw& draw : scene.draws) draw.count = draw.vertexCount = 3;
    for (Vec4& vertex : scene.vertices) vertex = {unit(), unit(), 0.5F, 1.0F};
    host.setScene(scene);
    const std::vector<float> first = host.draw();
    std::ranges::reverse(scene.draws);
    host.setScene(scene);
    EXPECT_TRUE(host.draw() == first) << samples << " samples";
  }
}

// Which class a tile has hangs on some of its records, which must be the same ones in each frame, wherever chance has
// put them: else the tile is deep in one frame and not in the next, with other roundings, or without room. (Only
// networks_test, with the pipelines of GPUs, has classes that differ.)
TEST_F(RasterPromisesTest, TheSameFrameAgain) {
  if (backend().features().multisampled.empty()) GTEST_SKIP() << "no samples";
  std::mt19937 random(4);
  const auto unit = [&] { return std::uniform_real_distribution<float>(0.0F, 1.0F)(random); };
  RasterHostDesc desc;
  desc.samples = 4;
  desc.width = desc.height = 64;
  RasterHost host(desc);
  RasterScene scene;
  scene.behind = {0.25F, 0.5F, 0.75F, 1.0F};
  const auto add = [&](float left, float top, float right, float bottom, float depth, std::uint32_t cells) {
    VitrailVkRasterDraw draw{};
    draw.instanceCount = 1;
    draw.vertexOffset = static_cast<std::int32_t>(scene.vertices.size());
    draw.firstIndex = static_cast<std::uint32_t>(scene.indices.size());
    draw.vertexCount = (cells + 1) * (cells + 1);
    draw.count = 6 * cells * cells;
    draw.word = static_cast<std::uint32_t>(scene.colors.size());
    scene.colors.push_back({unit(), unit(), unit(), 0.1F + 0.1F * unit()});
    scene.draws.push_back(draw);
    for (std::uint32_t i = 0; i < draw.vertexCount; ++i) {
      const std::uint32_t x = i % (cells + 1);
      const std::uint32_t y = i / (cells + 1);
      scene.vertices.push_back({std::lerp(left, right, static_cast<float>(x) / static_cast<float>(cells)),
                                std::lerp(top, bottom, static_cast<float>(y) / static_cast<float>(cells)), depth,
                                1.0F});
      if (x == cells || y == cells) continue;
      for (const std::uint32_t corner : {i, i + 1, i + cells + 1, i + 1, i + cells + 2, i + cells + 1}) {
        scene.indices.push_back(corner);
      }
    }
  };
  for (int i = 0; i < 7; ++i) {
    add(-1.0F - 0.1F * unit(), -1.0F - 0.1F * unit(), 1.0F + 0.1F * unit(), 1.0F + 0.1F * unit(), 0.1F + 0.8F * unit(),
        23);
  }
  for (int tile = 0; tile < 8; ++tile) { // in a pixel of some tiles more at one depth than some pipelines keep
    const float at = -1.0F + 0.25F * static_cast<float>(tile);
    for (int i = 0; i < 10; ++i) add(at, at, at + 0.04F, at + 0.04F, 0.5F, 1);
  }
  host.setScene(scene);
  const std::vector<float> first = host.draw();
  int others = 0;
  for (int i = 0; i < 40; ++i) {
    host.drawOnce();
    EXPECT_TRUE(host.stats().exact) << "frame " << i;
    others += host.picture() == first ? 0 : 1;
    ASSERT_EQ(host.raster().update(), VK_SUCCESS);
  }
  EXPECT_EQ(others, 0) << "of 40 frames";
}

// Surfaces that are not there (alpha 0) count towards those at one depth until they are shaded; there is room for some.
TEST_F(RasterPromisesTest, SurfacesThatAreNotThereAtOneDepth) {
  std::vector<Sheet> sheets;
  for (int i = 0; i < 10; ++i) {
    const float shade = static_cast<float>(i) / 10.0F;
    sheets.push_back({0.5F, {shade, 1.0F - shade, 0.5F, 0.5F}});
  }
  for (int i = 0; i < 8; ++i) sheets.push_back({0.5F, {1.0F, 1.0F, 1.0F, 0.0F}});
  RasterHost host({});
  host.setScene(sheetsOf(sheets, {0.0F, 0.0F, 0.0F, 1.0F}));
  host.draw();
  const Vec4 first = host.at(3, 2);
  std::ranges::reverse(sheets);
  host.setScene(sheetsOf(sheets, {0.0F, 0.0F, 0.0F, 1.0F}));
  host.draw();
  EXPECT_EQ(host.at(3, 2), first);
}

// Twelve sheets at one depth are in the order of their colours, along their diagonals, too, where a pixel of several
// samples has both halves of each: 24 surfaces. Else a seam would be seen.
TEST_F(RasterPromisesTest, HalvesOfSheetsAtOneDepth) {
  for (const std::uint32_t samples : backend().features().multisampled) {
    RasterHostDesc desc;
    desc.samples = samples;
    RasterHost host(desc);
    std::vector<Sheet> sheets;
    for (int i = 0; i < 12; ++i) {
      const float shade = static_cast<float>(i * 5 % 12) / 12.0F;
      sheets.push_back({0.5F, {shade, 1.0F - shade, 0.5F, 0.5F}});
    }
    host.setScene(sheetsOf(sheets, {0.0F, 0.0F, 0.0F, 1.0F}, 0.5F));
    host.draw();
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(host.at(15, 0).at(c), host.at(0, 0).at(c), 1e-4) << samples;
  }
}

// ---- What colours and positions are

// What is left out behind little light (mostLight) would be missing in the picture's alpha, too, where what lies behind
// is not opaque.
TEST_F(RasterPromisesTest, AlphaWhereLightIsLeftOut) {
  RasterHostDesc desc;
  desc.blendModes = 1U << VITRAIL_BLEND_OVER;
  RasterHost host(desc);
  for (const float most : {1.0F, 0.001F, 1e-5F}) {
    std::vector<Sheet> sheets;
    for (int i = 0; i < 60; ++i) sheets.push_back({0.1F + 0.01F * static_cast<float>(i), {most, 0.0F, 0.0F, 0.1F}});
    const Vec4 behind{};
    host.info().mostLight = most;
    host.setScene(sheetsOf(sheets, behind));
    host.draw();
    EXPECT_NEAR(host.at(3, 3)[3], sheetsBlended(sheets, behind)[3], 0.35 / 255.0) << "most light " << most;
  }
}

// Weights are quotients of products of clip space, which floats hold as far as the guide says.
TEST_F(RasterPromisesTest, ClipSpaceOfManyScales) {
  RasterHost host({});
  std::optional<Vec4> first;
  for (const float scale : {1.0F, 1e-12F, 1e12F}) {
    RasterScene scene = sheetsOf({{0.5F, {1.0F, 1.0F, 1.0F, 1.0F}}}, {0.25F, 0.5F, 0.75F, 1.0F});
    scene.vertices = {{-1.0F, -1.0F, 0.5F, 1.0F}, {-1.0F, 1.0F, 0.5F, 1.0F}, {4.0F, -4.0F, 2.0F, 4.0F}};
    for (Vec4& vertex : scene.vertices) {
      for (float& value : vertex) value *= scale;
    }
    scene.indices = {0, 1, 2};
    scene.draws[0].count = scene.draws[0].vertexCount = 3;
    scene.draws[0].word = 2U << 16U; // shows its weights
    host.setScene(scene);
    host.draw();
    if (!first) first = host.at(10, 12);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(host.at(10, 12).at(c), first->at(c), 1e-5) << "scale " << scale;
  }
}

// Colours as nodes hold them: not negative, alpha at most 1, a NaN is 0.
TEST_F(RasterPromisesTest, ColoursThatAreNone) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const std::array<float, 9> values{0.0F, 1.0F, -1.0F, 2.0F, 0.5F, kNan, kInfinite, -kInfinite, 1e-40F};
  for (const std::uint32_t samples : oneAndSeveral()) {
    if (samples > 2) continue; // each needs pipelines
    for (const std::uint32_t modes : {0U, 1U << VITRAIL_BLEND_OVER}) {
      RasterHostDesc desc;
      desc.samples = samples;
      desc.blendModes = modes;
      RasterHost host(desc);
      for (std::size_t i = 0; i < values.size() * values.size() * 4; ++i) {
        const float value = values.at(i / 4 % values.size());
        const float alpha = values.at(i / 4 / values.size());
        const auto blend = static_cast<VitrailBlend>(i % 4);
        if (modes != 0 && blend != VITRAIL_BLEND_OVER) continue;
        const std::vector<Sheet> sheets = {{0.25F, {0.5F, 0.25F, 0.75F, 0.25F}},
                                           {0.5F, {value, 0.5F, value, alpha}, blend},
                                           {0.75F, {0.125F, 0.25F, 0.75F, 0.5F}}};
        const Vec4 behind{0.25F, 0.5F, 0.75F, 1.0F};
        host.setScene(sheetsOf(sheets, behind));
        host.draw();
        SCOPED_TRACE(testing::Message() << samples << " samples, " << value << ", alpha " << alpha << ", " << blend);
        expectColor(host.at(3, 3), sheetsBlended(sheets, behind), 1e-4);
      }
    }
  }
}

// Filters brighter than 1 multiply light beyond what a float holds. What is dark behind them is dark.
TEST_F(RasterPromisesTest, LightBeyondAllFloatsStaysANumber) {
  for (const std::uint32_t samples : oneAndSeveral()) {
    if (samples > 2) continue; // each needs pipelines
    RasterHostDesc desc;
    desc.samples = samples;
    RasterHost host(desc);
    for (const std::uint32_t count : {3U, 12U, 40U}) {
      std::vector<Sheet> sheets;
      for (std::uint32_t i = 0; i < count; ++i) {
        sheets.push_back(
            {0.1F + 0.01F * static_cast<float>(i), {65504.0F, 65504.0F, 65504.0F, 1.0F}, VITRAIL_BLEND_MULTIPLY});
      }
      sheets.push_back({0.9F, {0.0F, 0.0F, 0.0F, 1.0F}, VITRAIL_BLEND_MULTIPLY});
      host.setScene(sheetsOf(sheets, {0.25F, 0.5F, 0.75F, 1.0F}));
      host.draw();
      for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(host.at(3, 3).at(c), 0.0F) << samples << " samples, " << count;
    }
  }
}

// However a triangle is clipped, or two at an edge, no pixel has it twice.
TEST_F(RasterPromisesTest, ClippedTrianglesCoverOnce) {
  constexpr std::uint32_t kPixels = 128;
  RasterHostDesc desc;
  desc.width = desc.height = kPixels;
  RasterHost host(desc);
  std::mt19937 random(77);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  std::uint32_t once = 0;
  std::uint32_t others = 0;
  for (int i = 0; i < 300; ++i) {
    RasterScene scene = sheetsOf({{0.5F, {1.0F, 0.0F, 0.0F, 0.5F}}}, {0.0F, 0.0F, 0.0F, 1.0F});
    const double reach = std::exp2(between(0.0, 14.0));
    const std::array<double, 4> a{between(-2, 2), between(-2, 2), between(0, 1), between(0.1, 2)};
    const std::array<double, 4> u{between(-1, 1) * reach, between(-1, 1) * reach, between(-1, 1), between(-2, 2)};
    const std::array<double, 4> v{between(-2, 2), between(-1, 1) * reach, between(-1, 1), between(-2, 2)};
    for (std::size_t corner = 0; corner < 4; ++corner) {
      for (std::size_t k = 0; k < 4; ++k) {
        const double value = a.at(k) + (corner % 2 == 1 ? u.at(k) : 0.0) + (corner >= 2 ? v.at(k) : 0.0);
        scene.vertices.at(corner).at(k) = static_cast<float>(value);
      }
    }
    const float plane[1][4] = {{static_cast<float>(between(-1, 1)), static_cast<float>(between(-1, 1)),
                                static_cast<float>(between(-1, 1)), static_cast<float>(between(0, 1))}};
    host.info().clipPlaneCount = static_cast<std::uint32_t>(i % 2);
    host.info().clipPlanes = plane;
    host.setScene(scene);
    host.draw();
    for (std::size_t k = 0; k < host.picture().size(); k += 4) {
      const float red = host.picture()[k];
      once += red == 0.5F ? 1 : 0;
      others += red != 0.5F && red != 0.0F ? 1 : 0;
    }
  }
  EXPECT_GT(once, 100000U);
  EXPECT_EQ(others, 0U);
}

// ---- Draws, frames, budgets

// Draws of which nothing is drawn, between those that are: indices from an odd one on.
TEST_F(RasterPromisesTest, VeryManyDraws) {
  std::mt19937 random(8);
  for (const bool keeps : {true, false}) {
    const VkIndexType type = keeps ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32;
    RasterHostDesc desc;
    desc.keepsPositions = keeps;
    desc.indexType = type;
    RasterHost host(desc);
    for (const std::uint32_t count : {255U, 256U, 257U, 70001U}) {
      std::vector<Sheet> shown;
      RasterScene scene = sheetsOf({{0.0F, {}}}, {0.25F, 0.5F, 0.75F, 1.0F});
      const VitrailVkRasterDraw whole = scene.draws[0];
      scene.draws.clear();
      scene.colors.clear();
      scene.indices.insert(scene.indices.begin(), 9);
      for (std::uint32_t i = 0; i < count; ++i) {
        VitrailVkRasterDraw draw = whole;
        draw.firstIndex = 1;
        draw.word = static_cast<std::uint32_t>(shown.size());
        draw.firstInstance = draw.word;
        const std::uint32_t kind = random() % (count / 20) == 0 || i + 1 == count ? 0 : 1 + random() % 4;
        if (kind == 0) {
          const auto shade = static_cast<float>(random() % 17) / 16.0F;
          shown.push_back({static_cast<float>(shown.size() * 37 % 101 + 1) / 103.0F, {shade, 0.5F, 0.25F, 0.25F}});
          scene.colors.push_back(shown.back().color);
          scene.shifts.push_back({0.0F, 0.0F, shown.back().depth, 0.0F});
        }
        if (kind == 1) draw.count = 2;
        if (kind == 2) draw.instanceCount = 0;
        if (kind == 3 || kind == 4) {
          draw = {};
          draw.instanceCount = kind == 3 ? 1 : 0xffffffffU;
          draw.firstIndex = 0xffffffffU;
          draw.firstInstance = 0xffffff00U;
          draw.blend = 77;
        }
        scene.draws.push_back(draw);
      }
      SCOPED_TRACE(testing::Message() << "keeps " << keeps << ", indices " << type << ", draws " << count);
      host.setScene(scene);
      host.draw();
      expectColor(host.at(3, 2), sheetsBlended(shown, scene.behind), 2e-4);
      EXPECT_EQ(host.stats().draws, count);
      EXPECT_EQ(host.stats().instances, shown.size());
      EXPECT_EQ(host.stats().vertices, keeps ? 4 * shown.size() : 0);
    }
  }
}

// Other draws and other extents from frame to frame, also between a frame and the one that is drawn because the first
// had no room.
TEST_F(RasterPromisesTest, FramesThatHaveNothingInCommon) {
  for (const std::uint32_t inFlight : {1U, 2U, 8U}) {
    RasterHostDesc desc;
    desc.framesInFlight = inFlight;
    desc.width = desc.height = 64;
    RasterHost host(desc);
    std::mt19937 random(inFlight);
    for (int i = 0; i < 40; ++i) {
      std::vector<Sheet> sheets;
      const std::uint32_t count = 1 + static_cast<std::uint32_t>(random() % (i % 10 == 9 ? 400 : 30));
      for (std::uint32_t k = 0; k < count; ++k) {
        const float shade = static_cast<float>(random() % 17) / 16.0F;
        sheets.push_back({static_cast<float>(k + 1) / static_cast<float>(count + 2),
                          {shade, 0.5F, 0.25F, count > 40 ? 0.01F : 0.125F}});
      }
      const Vec4 behind{0.25F, 0.5F, 0.75F, 1.0F};
      const VkExtent2D extent{1 + static_cast<std::uint32_t>(random() % 64),
                              1 + static_cast<std::uint32_t>(random() % 64)};
      if (random() % 2 == 0) {
        ASSERT_EQ(host.raster().resize(extent), VK_SUCCESS);
      }
      host.setScene(sheetsOf(sheets, behind));
      host.info().sameDraws = VK_FALSE;
      host.drawOnce();
      host.info().sameDraws = VK_TRUE;
      for (int k = 0; k < 5 && host.stats().exact == VK_FALSE; ++k) {
        ASSERT_EQ(host.raster().update(), VK_SUCCESS);
        if (random() % 4 == 0) {
          ASSERT_EQ(host.raster().resize(extent), VK_SUCCESS);
        }
        host.drawOnce();
      }
      EXPECT_EQ(host.stats().exact, VK_TRUE);
      expectColor(host.at(0, 0), sheetsBlended(sheets, behind), 3e-4);
    }
  }
}

// Any budget: the picture is exact after some frames, the same bits, and stays so; or it is refused.
TEST_F(RasterPromisesTest, AnyBudget) {
  std::mt19937 random(3);
  const auto unit = [&] { return std::uniform_real_distribution<double>(0.0, 1.0)(random); };
  for (int i = 0; i < 4; ++i) {
    RasterHostDesc desc;
    desc.width = 8 + static_cast<std::uint32_t>(random() % 120);
    desc.height = 8 + static_cast<std::uint32_t>(random() % 120);
    desc.samples = i % 3 == 2 ? oneAndSeveral().back() : 1;
    desc.keepsPositions = i % 2 == 0;
    RasterScene scene = sheetsOf({{0.5F, {0.5F, 0.25F, 1.0F, 0.02F}}}, {});
    const auto triangles = static_cast<std::uint32_t>(std::exp2(3.0 + 9.0 * unit()));
    const double size = std::exp2(unit() * 3.0 - 3.0);
    scene.vertices.clear();
    for (std::uint32_t k = 0; k < triangles; ++k) {
      const double x = unit() * 2.0 - 1.0;
      const double y = unit() * 2.0 - 1.0;
      for (int c = 0; c < 3; ++c) {
        scene.vertices.push_back({static_cast<float>(x + (unit() - 0.5) * size),
                                  static_cast<float>(y + (unit() - 0.5) * size),
                                  i % 2 == 0 ? 0.5F : static_cast<float>(0.1 + 0.8 * unit()), 1.0F});
      }
    }
    scene.indices.resize(3 * std::size_t{triangles});
    std::iota(scene.indices.begin(), scene.indices.end(), 0U);
    scene.draws[0].count = scene.draws[0].vertexCount = 3 * triangles;
    RasterHost plenty(desc);
    plenty.setScene(scene);
    const std::vector<float> expected = plenty.draw(20);
    const double most = std::log2(static_cast<double>(plenty.raster().memory().tileBytes));
    for (int k = 0; k < 3; ++k) {
      desc.memoryBudget = static_cast<VkDeviceSize>(std::exp2(14.0 + unit() * (most - 14.0)));
      SCOPED_TRACE(testing::Message() << "scene " << i << ", " << desc.width << 'x' << desc.height << ", "
                                      << desc.samples << " samples, " << triangles << " triangles, budget "
                                      << desc.memoryBudget);
      std::optional<RasterHost> host;
      try {
        host.emplace(desc);
        host->setScene(scene);
        host->draw(20);
      } catch (const HostError& error) {
        EXPECT_EQ(std::string(error.what()).find("not exact"), std::string::npos);
        expectOneLine("memoryBudget");
        continue;
      }
      EXPECT_TRUE(host->picture() == expected);
      EXPECT_LE(host->raster().memory().tileBytes, desc.memoryBudget + 8192);
      for (int frame = 0; frame < 130 && i + k == 0; ++frame) { // long enough to follow needs down
        ASSERT_EQ(host->raster().update(), VK_SUCCESS);
        host->drawOnce();
        ASSERT_EQ(host->stats().exact, VK_TRUE) << "frame " << frame;
      }
      EXPECT_TRUE(host->picture() == expected);
    }
  }
}

} // namespace
} // namespace vitrail::tests::vulkan
