// Frames whose pixels are known beforehand: long lists, equal depths, what light does not come through, shapes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include "scene.h"

namespace vitrail::tests::raster {
namespace {

constexpr std::array<float, 4> kBehind{0.2F, 0.5F, 0.7F, 1.0F};

// A triangle over the whole picture, at a depth.
void addFull(std::vector<Position>& positions, float depth) {
  positions.insert(positions.end(),
                   {{-1.0F, -1.0F, depth, 1.0F}, {3.0F, -1.0F, depth, 1.0F}, {-1.0F, 3.0F, depth, 1.0F}});
}

// Layers in a random order. Layer i, the i-th from the viewer, is as bright as the shade function makes it.
struct Layers {
  std::vector<Position> positions;
  std::vector<std::uint32_t> places; // of each triangle: which layer it is
  float alpha = 0.0F;
  std::uint32_t count = 0;

  Layers(std::uint32_t layers, Random& random)
      : places(layers), alpha(std::min(0.5F, 4.0F / static_cast<float>(layers))), count(layers) {
    std::iota(places.begin(), places.end(), 0U);
    std::shuffle(places.begin(), places.end(), random.engine());
    for (const std::uint32_t place : places) {
      addFull(positions, static_cast<float>(place + 1) / static_cast<float>(layers + 2));
    }
  }
  float brightness(std::uint32_t place) const { return 0.1F + 0.8F * static_cast<float>(place % 17) / 16.0F; }
  double expected(std::uint32_t channel) const {
    double color = 0.0;
    double through = 1.0;
    for (std::uint32_t i = 0; i < count; ++i) {
      color += through * double{alpha} * (channel == 0 ? double{brightness(i)} : 0.25);
      through *= 1.0 - double{alpha};
    }
    return color + through * double{kBehind.at(channel)};
  }
};

void shadeLayers(void* user, VitrailCpuFragments* f) {
  const Layers& layers = *static_cast<Layers*>(user);
  for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
    f->color[0][i] = layers.brightness(layers.places[f->triangle[i]]);
    f->color[1][i] = 0.25F;
    f->color[2][i] = 0.25F;
    f->color[3][i] = layers.alpha;
  }
}

TEST(LongListsTest, AreBlendedInOrder) {
  Random random(40);
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions);
    std::vector<std::uint32_t> lengths(70);
    std::iota(lengths.begin(), lengths.end(), 1U);
    lengths.insert(lengths.end(), {95, 96, 97, 127, 128, 129, 500, 1000, 1025, 20000, 100000});
    for (const std::uint32_t length : lengths) {
      Layers layers(length, random);
      Picture picture(3, 2, kBehind);
      VitrailCpuFrame frame = picture.frame();
      VitrailCpuDraw draw = drawOf(layers.positions);
      draw.shade = shadeLayers;
      draw.shadeUser = &layers;
      draw.brightest = 1.0F;
      VitrailStats stats{};
      ASSERT_EQ(raster.render(frame, {&draw, 1}, &stats), VITRAIL_SUCCESS);
      for (std::uint32_t c = 0; c < 3; ++c) {
        for (std::uint32_t pixel = 0; pixel < 6; ++pixel) {
          ASSERT_NEAR(picture.pixels[4 * pixel + c], layers.expected(c), 2e-5)
              << length << " layers, " << nameOf(instructions);
        }
      }
      EXPECT_EQ(stats.layersMax, length);
      EXPECT_EQ(stats.fragmentsRequested, 6U * length);
      EXPECT_EQ(stats.coveredPixels, 6U);
    }
  }
}

// Panes across several tiles that cross each other. From the second tile on they are put in order before they are drawn
// (TileWorker::orderLarge()), which no picture shows.
class CrossingPanes {
 public:
  static constexpr std::uint32_t kWidth = 100;
  static constexpr std::uint32_t kHeight = 70;

  // Of so many a few have a corner behind the eye.
  explicit CrossingPanes(std::uint32_t behindTheEye) : positions_(90) {
    Random random(6);
    for (std::uint32_t i = 0; i < positions_.size(); ++i) {
      std::vector<Position>& corners = positions_[i];
      const float middle = random.single(0.3, 0.7);
      addFull(corners, middle);
      for (Position& corner : corners) corner[2] += random.single(-0.1, 0.1);
      if (i % 15 == 7 && i / 15 < behindTheEye) corners[1] = {1.0F, 0.3F, -0.25F * middle, -0.25F};
    }
  }

  std::vector<VitrailCpuDraw> draws() const {
    std::vector<VitrailCpuDraw> draws;
    for (std::uint32_t i = 0; i < positions_.size(); ++i) {
      draws.push_back(drawOf(positions_[i]));
      for (float& channel : draws.back().color) channel = brightness(i);
      draws.back().color[3] = kAlpha;
    }
    return draws;
  }

  // At a pixel's centre, the first channel; nothing where two depths are too near to tell.
  std::optional<double> at(std::uint32_t x, std::uint32_t y, bool nearestIsOne) const {
    const double right = (x + 0.5) / kWidth / 2.0; // the second corner's share, and the third's
    const double down = (y + 0.5) / kHeight / 2.0;
    std::vector<std::pair<double, std::uint32_t>> seen;
    for (std::uint32_t i = 0; i < positions_.size(); ++i) {
      const auto z = [&](std::size_t c) { return double{positions_[i][c][2]}; };
      const double depth = z(0) + right * (z(1) - z(0)) + down * (z(2) - z(0));
      seen.emplace_back(nearestIsOne ? -depth : depth, i);
    }
    std::sort(seen.begin(), seen.end());
    double color = 0.0;
    double through = 1.0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (i > 0 && seen[i].first - seen[i - 1].first < 1e-6) return std::nullopt;
      color += through * double{kAlpha} * double{brightness(seen[i].second)};
      through *= 1.0 - double{kAlpha};
    }
    return color + through * double{kBehind[0]};
  }

 private:
  static constexpr float kAlpha = 0.05F;
  static float brightness(std::uint32_t pane) { return 0.1F + 0.1F * static_cast<float>(pane % 7); }

  std::vector<std::vector<Position>> positions_;
};

TEST(LongListsTest, OfLargeTrianglesThatCross) {
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    for (const VitrailDepthOrder order : {VITRAIL_DEPTH_NEAREST_IS_ZERO, VITRAIL_DEPTH_NEAREST_IS_ONE}) {
      for (const std::uint32_t behindTheEye : {0U, 4U}) {
        SCOPED_TRACE(std::string(nameOf(instructions)) + ", order " + std::to_string(order) + ", " +
                     std::to_string(behindTheEye) + " behind the eye");
        const CrossingPanes panes(behindTheEye);
        Random random(9);
        Picture first(CrossingPanes::kWidth, CrossingPanes::kHeight, kBehind);
        for (int turn = 0; turn < 5; ++turn) {
          Raster raster(instructions, turn == 4 ? 3 : 1);
          std::vector<VitrailCpuDraw> draws = panes.draws();
          if (turn == 1) std::reverse(draws.begin(), draws.end());
          if (turn > 1) std::shuffle(draws.begin(), draws.end(), random.engine());
          Picture picture(CrossingPanes::kWidth, CrossingPanes::kHeight, kBehind);
          VitrailCpuFrame frame = picture.frame();
          frame.depthOrder = order;
          if (turn == 3) frame.memoryBudget = 65536;
          ASSERT_EQ(raster.render(frame, draws), VITRAIL_SUCCESS);
          if (turn == 0) first.pixels = picture.pixels;
          EXPECT_TRUE(picture.pixels == first.pixels) << "turn " << turn;
        }
        if (behindTheEye > 0) continue;
        std::uint32_t compared = 0;
        for (std::uint32_t y = 0; y < CrossingPanes::kHeight; ++y) {
          for (std::uint32_t x = 0; x < CrossingPanes::kWidth; ++x) {
            const auto expected = panes.at(x, y, order == VITRAIL_DEPTH_NEAREST_IS_ONE);
            if (!expected) continue;
            ++compared;
            ASSERT_NEAR(first.at(x, y)[0], *expected, 2e-5) << x << ' ' << y;
          }
        }
        EXPECT_GT(compared, CrossingPanes::kWidth * CrossingPanes::kHeight * 9 / 10);
      }
    }
  }
}

// Flat draws, as many layers each as there are; at one depth or at many.
TEST(LongListsTest, OfFlatDrawsAddUp) {
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions);
    for (const std::uint32_t samples : {1U, 4U}) {
      for (const std::uint32_t length : {1U, 2U, 33U, 1000U, 100000U}) {
        for (const bool isEqual : {true, false}) {
          if (samples > 1 && length > 1000) continue;
          std::vector<Position> positions;
          for (std::uint32_t i = 0; i < length; ++i) {
            addFull(positions, isEqual ? 0.5F : static_cast<float>(i) / static_cast<float>(length));
          }
          Picture picture(2, 2, kBehind);
          VitrailCpuFrame frame = picture.frame();
          frame.samples = samples;
          VitrailCpuDraw added = drawOf(positions);
          added.blend = VITRAIL_BLEND_ADDITIVE;
          added.color[0] = 0x1.0p-10F;
          added.color[3] = 0x1.0p-10F;
          VitrailCpuDraw over = drawOf(positions);
          const float alpha = std::min(0.5F, 3.0F / static_cast<float>(length));
          over.color[1] = 0.75F;
          over.color[3] = alpha;
          ASSERT_EQ(raster.render(frame, {&added, 1}), VITRAIL_SUCCESS);
          EXPECT_NEAR(picture.pixels[0], kBehind[0] + 0x1.0p-20 * length, 1e-5) << length << " layers";
          ASSERT_EQ(raster.render(frame, {&over, 1}), VITRAIL_SUCCESS);
          const double through = std::pow(1.0 - double{alpha}, length);
          EXPECT_NEAR(picture.pixels[1], 0.75 * (1.0 - through) + through * double{kBehind[1]}, 2e-5)
              << length << " layers, " << samples << " samples";
          EXPECT_NEAR(picture.pixels[3], 1.0F, 2e-5);
        }
      }
    }
  }
}

// Two layers at one depth: in one of the two orders, the same whichever comes first.
TEST(EqualDepthsTest, HaveAnOrderOfTheirOwn) {
  std::vector<Position> positions;
  addFull(positions, 0.25F);
  std::vector<VitrailCpuDraw> draws(2, drawOf(positions));
  const std::array<std::array<float, 4>, 2> colors{{{1.0F, 0.0F, 0.25F, 0.5F}, {0.0F, 1.0F, 0.5F, 0.25F}}};
  for (std::size_t i = 0; i < 2; ++i) std::copy(colors[i].begin(), colors[i].end(), draws[i].color);
  Raster raster(VITRAIL_CPU_BEST);
  const auto drawn = [&] {
    Picture picture(1, 1, kBehind);
    EXPECT_EQ(raster.render(picture.frame(), draws), VITRAIL_SUCCESS);
    return picture.pixels;
  };
  const std::vector<float> forward = drawn();
  std::swap(draws[0], draws[1]);
  EXPECT_EQ(drawn(), forward);
  const auto blended = [](const std::array<float, 4>& front, const std::array<float, 4>& back, std::size_t c) {
    const float behind = back[3] * back.at(c) + (1.0F - back[3]) * kBehind.at(c);
    return front[3] * front.at(c) + (1.0F - front[3]) * behind;
  };
  const bool isFirst = std::fabs(forward[0] - blended(colors[0], colors[1], 0)) < 1e-6F;
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(forward[c], isFirst ? blended(colors[0], colors[1], c) : blended(colors[1], colors[0], c), 1e-6);
  }
}

// ---- What is behind too little light

double srgbOf(double v) {
  const double clamped = std::clamp(v, 0.0, 1.0);
  return clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * std::pow(clamped, 1.0 / 2.4) - 0.055;
}

// Nothing is left out of a frame with a list hook.
int blendAll(void* /*user*/, std::uint32_t /*x*/, std::uint32_t /*y*/, const VitrailLayer* /*layers*/,
             std::uint32_t /*count*/, float* /*color*/) {
  return 0;
}

void expectLittleLeftOut(const Scene& scene, const std::string& what) {
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions);
    const Drawn drawn = draw(raster, scene);
    Scene whole;
    whole.frame = scene.frame;
    whole.frame.list = blendAll;
    whole.background = scene.background;
    whole.depth = scene.depth;
    const Drawn full = draw(raster, whole, scene.descs());
    double most = 0.0;
    for (std::size_t i = 0; i < drawn.pixels.size(); ++i) {
      most = std::max(most, std::fabs(srgbOf(drawn.pixels[i]) - srgbOf(full.pixels[i])));
    }
    EXPECT_LE(most, 0.35 / 255.0 + 1e-5) << what << ", " << nameOf(instructions);
  }
}

Scene nearlyOpaque(Random& random, float brightest, bool hasFilters, std::uint32_t samples) {
  SceneOptions options;
  options.width = 64;
  options.height = 40;
  options.samples = samples;
  options.draws = 30;
  options.primitives = 20;
  options.hasFilters = hasFilters;
  Scene scene = randomScene(random, options);
  for (const auto& each : scene.draws) {
    const float scale = random.below(4) == 0 ? brightest : 1.0F;
    each->desc.brightest = 2.0F * brightest;
    for (std::size_t c = 0; c < 4; ++c) {
      float& flat = each->desc.color[c];
      float& color = each->material.color.at(c);
      float& other = each->material.other.at(c);
      for (float* value : {&flat, &color, &other}) *value = c == 3 ? 1.0F - random.single(0.0, 0.2) : *value * scale;
    }
    if (each->desc.blend == VITRAIL_BLEND_ADDITIVE && !hasFilters)
      each->desc.blend = VITRAIL_BLEND_OVER; // has no bound
    if (each->desc.blend != VITRAIL_BLEND_MULTIPLY) continue;
    each->desc.brightest = 1.0F;
    for (std::size_t c = 0; c < 3; ++c) { // dark, and never brighter than what it filters
      each->desc.color[c] = std::min(each->desc.color[c], 0.3F);
      each->material.color.at(c) = std::min(each->material.color.at(c), 0.3F);
      each->material.other.at(c) = std::min(each->material.other.at(c), 0.3F);
    }
  }
  return scene;
}

TEST(LittleLightTest, IsLeftOutWithinTheBound) {
  Random random(41);
  for (const std::uint32_t samples : {1U, 4U}) {
    for (const bool hasFilters : {false, true}) {
      for (const float brightest : {1.0F, 30.0F, 30000.0F}) {
        for (int i = 0; i < 3; ++i) {
          expectLittleLeftOut(nearlyOpaque(random, brightest, hasFilters, samples),
                              "colours up to " + std::to_string(brightest));
        }
      }
    }
  }
}

// Surfaces that send light and hide nothing, or little, behind one that lets next to none through: each is too little
// to be seen, and all of them are not.
TEST(LittleLightTest, AddsUp) {
  constexpr std::size_t kSurfaces = 3000;
  constexpr double kThrough = 0x1.0p-20;
  std::vector<Position> front;
  std::vector<Position> behind;
  addFull(front, 0.1F);
  for (std::size_t i = 0; i < kSurfaces; ++i) addFull(behind, 0.2F + 0.0002F * static_cast<float>(i));
  struct Case {
    VitrailBlend blend;
    float color;
    float alpha;
  };
  for (const auto& [blend, color, alpha] :
       {Case{VITRAIL_BLEND_ADDITIVE, 4.0F, 0.5F}, Case{VITRAIL_BLEND_PREMULTIPLIED, 2.0F, 0.0F},
        Case{VITRAIL_BLEND_PREMULTIPLIED, 2.0F, 0x1.0p-12F}, Case{VITRAIL_BLEND_OVER, 8192.0F, 0x1.0p-12F}}) {
    const double sent = blend == VITRAIL_BLEND_PREMULTIPLIED ? color : double{color} * alpha;
    const double hidden = blend == VITRAIL_BLEND_ADDITIVE ? 0.0 : alpha;
    for (const bool isShaded : {false, true}) {
      std::vector<VitrailCpuDraw> draws{drawOf(front), drawOf(behind)};
      draws[0].color[3] = 1.0F - static_cast<float>(kThrough);
      draws[1].blend = blend;
      std::array<float, 4> given{color, color, color, alpha};
      std::copy(given.begin(), given.end(), draws[1].color);
      if (isShaded) {
        draws[1].shade = [](void* user, VitrailCpuFragments* fragments) {
          const auto& of = *static_cast<const std::array<float, 4>*>(user);
          for (std::size_t c = 0; c < 4; ++c) std::fill_n(fragments->color[c], VITRAIL_CPU_LANES, of[c]);
        };
        draws[1].shadeUser = &given;
        draws[1].brightest = color;
      }
      for (const VitrailCpuInstructions instructions : instructionsHere()) {
        Raster raster(instructions);
        Picture picture(2, 2);
        ASSERT_EQ(raster.render(picture.frame(), draws), VITRAIL_SUCCESS);
        const double layers = hidden == 0.0 ? kSurfaces : (1.0 - std::pow(1.0 - hidden, kSurfaces)) / hidden;
        EXPECT_NEAR(srgbOf(picture.pixels[0]), srgbOf(kThrough * sent * layers), 0.01 / 255.0)
            << blend << ", alpha " << alpha << (isShaded ? ", shaded, " : ", ") << nameOf(instructions);
      }
    }
  }
}

// Lights that are rounded the same way each time.
TEST(ManyLightsTest, AreWithinTheErrorBound) {
  constexpr std::uint32_t kLights = 40'000;
  constexpr double kLight = 100.4 * 0x1.0p-24;
  std::vector<Position> first;
  std::vector<Position> others;
  addFull(first, 0.1F);
  for (std::uint32_t i = 0; i < kLights; ++i) addFull(others, 0.2F + 1e-5F * static_cast<float>(i));
  std::vector<VitrailCpuDraw> draws{drawOf(first), drawOf(others)};
  for (VitrailCpuDraw& draw : draws) {
    draw.blend = VITRAIL_BLEND_ADDITIVE;
    draw.color[3] = 1.0F;
  }
  draws[0].color[0] = 0.5F;
  draws[1].color[0] = static_cast<float>(kLight);
  Raster raster;
  Picture picture(1, 1);
  VitrailStats stats{};
  ASSERT_EQ(raster.render(picture.frame(), draws, &stats), VITRAIL_SUCCESS);
  EXPECT_EQ(stats.layersMax, kLights + 1);
  EXPECT_EQ(stats.exact, 1U);
  const double error = std::fabs(srgbOf(picture.pixels[0]) - srgbOf(0.5 + kLight * kLights)) * 255.0;
  EXPECT_GT(error, 0.1); // that it is a hard case
  EXPECT_LE(error, double{stats.errorBound} - 0.5);
}

// Filters that make light brighter, behind a surface that lets next to none through.
TEST(LittleLightTest, IsNotMadeBrightAgainUnseen) {
  std::vector<Position> front;
  std::vector<Position> middle;
  std::vector<Position> back;
  addFull(front, 0.1F);
  addFull(back, 0.9F);
  for (int i = 0; i < 3; ++i) addFull(middle, 0.2F + 0.1F * static_cast<float>(i));
  std::vector<VitrailCpuDraw> draws{drawOf(front), drawOf(middle), drawOf(back)};
  draws[0].color[3] = 1.0F - 0x1.0p-22F;
  draws[1].blend = VITRAIL_BLEND_MULTIPLY;
  std::fill_n(draws[1].color, 3, 30.0F);
  draws[1].color[3] = 1.0F;
  std::fill_n(draws[2].color, 4, 1.0F);
  Raster raster(VITRAIL_CPU_BEST);
  Picture picture(2, 2);
  ASSERT_EQ(raster.render(picture.frame(), draws), VITRAIL_SUCCESS);
  EXPECT_NEAR(srgbOf(picture.pixels[0]), srgbOf(27000.0 * 0x1.0p-22), 1.0 / 20.0 / 255.0);
}

// ---- Shapes

std::uint32_t coveredPixels(VitrailCpuDraw draw, std::uint32_t side) {
  Raster raster(VITRAIL_CPU_BEST);
  Picture picture(side, side);
  VitrailStats stats{};
  std::fill_n(draw.color, 4, 0.5F);
  EXPECT_EQ(raster.render(picture.frame(), {&draw, 1}, &stats), VITRAIL_SUCCESS);
  EXPECT_EQ(stats.layersMax, stats.coveredPixels > 0 ? 1U : 0U);
  return stats.coveredPixels;
}

TEST(PointsTest, AreSquares) {
  for (const float size : {1.0F, 2.0F, 3.0F, 8.0F, 17.0F}) {
    const auto whole = static_cast<std::uint32_t>(size);
    const std::vector<Position> corner{inPixels(64, 64, 32.0, 32.0)};
    VitrailCpuDraw draw = drawOf(corner);
    draw.topology = VITRAIL_CPU_POINTS;
    draw.pointSize = size;
    EXPECT_EQ(coveredPixels(draw, 64), whole * whole) << size;
    const std::vector<Position> outside{inPixels(64, 64, 0.0, 0.0)}; // a quarter of it is within the picture
    draw.positions = outside[0].data();
    if (whole % 2 == 0) {
      EXPECT_EQ(coveredPixels(draw, 64), whole * whole / 4) << size;
    }
    const std::vector<Position> behind{{0.0F, 0.0F, -0.5F, 1.0F}};
    draw.positions = behind[0].data();
    EXPECT_EQ(coveredPixels(draw, 64), 0U) << size;
  }
}

TEST(LinesTest, CoverAPixelAStep) {
  for (const auto& [x, y] :
       {std::pair{40.0, 7.0}, {-20.0, 3.0}, {5.0, 30.0}, {-1.0, -19.0}, {25.0, 0.0}, {0.0, 11.0}}) {
    const std::vector<Position> ends{inPixels(128, 128, 64.25, 64.25), inPixels(128, 128, 64.25 + x, 64.25 + y)};
    VitrailCpuDraw draw = drawOf(ends);
    draw.topology = VITRAIL_CPU_LINES;
    EXPECT_EQ(coveredPixels(draw, 128), static_cast<std::uint32_t>(std::max(std::fabs(x), std::fabs(y))))
        << x << ", " << y;
  }
}

// ---- Vertices that are nowhere

// Clip space that is not finite: such triangles are not drawn. Which places became integers on the way there is for the
// undefined-behaviour sanitizer to tell.
TEST(NowhereTest, IsNotDrawn) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const Position hard[] = {
      {NAN, 0.0F, 0.5F, 1.0F},
      {0.0F, NAN, 0.5F, 1.0F},
      {0.0F, 0.0F, NAN, 1.0F},
      {0.0F, 0.0F, 0.5F, NAN},
      {kInfinite, 0.0F, 0.5F, 1.0F},
      {0.0F, -kInfinite, 0.5F, 1.0F},
      {0.0F, 0.0F, 0.5F, kInfinite},
      {kInfinite, 0.0F, 0.5F, kInfinite},
      {kInfinite, kInfinite, 1e37F, 1e38F},
      {0.0F, 0.0F, 0.0F, 0.0F},
  };
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions);
    for (const Position& corner : hard) {
      const bool isFinite = std::isfinite(0.0F * (corner[0] + corner[1] + corner[2] + corner[3]));
      for (const VitrailCpuTopology topology : {VITRAIL_CPU_TRIANGLES, VITRAIL_CPU_LINES, VITRAIL_CPU_POINTS}) {
        std::vector<Position> positions(6, corner);
        positions[1] = {1.0F, -1.0F, 0.5F, 1.0F};
        positions[2] = {-1.0F, 1.0F, 0.5F, 1.0F};
        if (topology == VITRAIL_CPU_POINTS) positions.resize(1);
        VitrailCpuDraw nowhere = drawOf(positions);
        nowhere.topology = topology;
        std::fill_n(nowhere.color, 4, 0.5F);
        Picture picture(40, 40);
        VitrailStats stats{};
        ASSERT_EQ(raster.render(picture.frame(), {&nowhere, 1}, &stats), VITRAIL_SUCCESS);
        for (const float value : picture.pixels) ASSERT_TRUE(std::isfinite(value));
        EXPECT_TRUE(isFinite || stats.coveredPixels == 0) << corner[0] << " " << corner[3] << ", " << topology;
      }
    }
  }
}

// Corners far beyond the guard band: the half of the picture on whose side they are.
TEST(FarAwayTest, CoversHalfOfThePicture) {
  const std::vector<Position> far{{1e6F, 0.0F, 0.5F, 1.0F}, {0.0F, -1e6F, 0.5F, 1.0F}, {0.0F, 1e6F, 0.5F, 1.0F}};
  EXPECT_EQ(coveredPixels(drawOf(far), 40), 800U);
}

// Both ends of an edge so far away that floats round what lies between them to anything.
TEST(FarAwayTest, EdgesThroughThePictureStayWhereTheyAre) {
  for (const float far : {1e4F, 1.1e6F, 1.3e8F, 1.7e10F}) {
    // Below a quarter of the lower half; over all of it.
    const std::vector<Position> below{
        {-far, 0.25F, 0.5F, 1.0F}, {far, 0.25F, 0.5F, 1.0F}, {0.3F * far, far, 0.5F, 1.0F}};
    EXPECT_EQ(coveredPixels(drawOf(below), 64), 24U * 64U) << far;
    const std::vector<Position> all{
        {-far, -far, 0.5F, 1.0F}, {far, 0.1F * far, 0.5F, 1.0F}, {-far, 0.9F * far, 0.5F, 1.0F}};
    EXPECT_EQ(coveredPixels(drawOf(all), 64), 64U * 64U) << far;
  }
}

// A floor of which the near plane cuts off what is behind the eye, as much again, and its edge right of the middle.
TEST(FarAwayTest, FloorsBeginAtTheEye) {
  constexpr double kNear = 0.01;
  for (const double extent : {1e3, 1e5, 1e6, 1e7, 1e8}) {
    const double far = 1.01 * extent;
    const auto at = [&](double x, double z) {
      return Position{static_cast<float>(x), 1.0F, static_cast<float>((z - kNear) * far / (far - kNear)),
                      static_cast<float>(z)};
    };
    const std::vector<Position> floor{at(0.003, -extent), at(0.003, extent), at(extent, 0.0)};
    EXPECT_EQ(coveredPixels(drawOf(floor), 256), 128U * 128U) << extent;
  }
}

} // namespace
} // namespace vitrail::tests::raster
