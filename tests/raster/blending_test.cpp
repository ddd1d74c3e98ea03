// Whole frames against the double-precision reference, feature by feature and all of them together.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "reference.h"

namespace vitrail::tests::raster {
namespace {

// What a fragment behind too little light may add, and rounding.
double toleranceOf(double value, std::uint32_t layers) {
  return 0.35 / 255.0 / 12.92 + (2e-6 + 2e-7 * layers) * (1.0 + std::fabs(value));
}

std::size_t undecidedOf(const Expected& expected) {
  return static_cast<std::size_t>(std::count(expected.isUndecided.begin(), expected.isUndecided.end(), true));
}

void expectDrawn(const Scene& scene, const Expected& expected, const Drawn& drawn, const std::string& what) {
  std::size_t wrong = 0;
  std::string first;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    if (expected.isUndecided[i]) continue;
    for (std::size_t c = 0; c < 4; ++c) {
      const double difference = std::fabs(double{drawn.pixels[4 * i + c]} - expected.pixels[i][c]);
      if (difference <= expected.noise[i] + toleranceOf(expected.pixels[i][c], expected.layers[i])) continue;
      if (wrong++ > 0) continue;
      first = "pixel " + std::to_string(i % scene.frame.width) + ", " + std::to_string(i / scene.frame.width) +
              " channel " + std::to_string(c) + ": " + std::to_string(drawn.pixels[4 * i + c]) + " and not " +
              std::to_string(expected.pixels[i][c]) + ", " + std::to_string(expected.layers[i]) + " layers";
    }
    const std::size_t samples = scene.frame.samples;
    for (std::size_t s = 0; !drawn.depth.empty() && s < samples; ++s) {
      const double difference = std::fabs(double{drawn.depth[i * samples + s]} - expected.depth[i * samples + s]);
      if (difference <= 0x1.0p-21 + expected.noise[i]) continue;
      if (wrong++ == 0) first = "depth of pixel " + std::to_string(i) + " off by " + std::to_string(difference);
    }
  }
  EXPECT_EQ(wrong, 0U) << what << "; " << first;
}

// Counts the pixels of scenes, and those of which the reference does not know what they must be.
struct Counted {
  std::size_t pixels = 0;
  std::size_t undecided = 0;
};

void expectScene(Counted& counted, std::uint64_t seed, const SceneOptions& options, const std::string& what) {
  Random random(seed);
  const Scene scene = randomScene(random, options);
  const Expected expected = expectedOf(scene);
  counted.pixels += expected.pixels.size();
  counted.undecided += undecidedOf(expected);
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions);
    expectDrawn(scene, expected, draw(raster, scene),
                what + ", seed " + std::to_string(seed) + ", " + nameOf(instructions));
  }
}

struct Feature {
  const char* name;
  void (*choose)(SceneOptions& options);
};

class BlendingTest : public testing::TestWithParam<Feature> {};

TEST_P(BlendingTest, IsThatOfTheReference) {
  std::uint64_t seed = 1;
  Counted counted;
  for (const std::uint32_t samples : {1U, 1U, 2U, 4U, 8U}) {
    SceneOptions options;
    options.samples = samples;
    GetParam().choose(options);
    expectScene(counted, seed++, options, std::to_string(samples) + " samples");
  }
  EXPECT_LT(counted.undecided * 5, counted.pixels);
}

void PrintTo(const Feature& feature, std::ostream* out) { *out << feature.name; }

const Feature kFeatures[] = {
    {"Flat", [](SceneOptions& o) { o.isFlat = true; }},
    {"FlatWithFilters", [](SceneOptions& o) { o.isFlat = o.hasFilters = true; }},
    {"Shaded", [](SceneOptions& o) { o.isShaded = true; }},
    {"ShadedWithFilters", [](SceneOptions& o) { o.isShaded = o.hasFilters = true; }},
    {"FlatAndShaded", [](SceneOptions& o) { o.hasFilters = true; }},
    {"Discards", [](SceneOptions& o) { o.isShaded = o.hasDiscards = o.hasOpaque = true; }},
    {"Opaque", [](SceneOptions& o) { o.hasOpaque = true; }},
    {"HostDepth", [](SceneOptions& o) { o.hasDepth = o.hasOpaque = true; }},
    {"HostDepthReversed",
     [](SceneOptions& o) {
       o.hasDepth = o.hasOpaque = true;
       o.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
     }},
    {"Reversed",
     [](SceneOptions& o) {
       o.hasFilters = true;
       o.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
     }},
    {"Direct3d", [](SceneOptions& o) { o.clipSpace = VITRAIL_CPU_CLIP_DIRECT3D; }},
    {"OpenGl",
     [](SceneOptions& o) {
       o.clipSpace = VITRAIL_CPU_CLIP_OPENGL;
       o.hasDepth = o.hasOpaque = true;
     }},
    {"Culling", [](SceneOptions& o) { o.hasCulling = o.hasOpaque = true; }},
    {"LinesAndPoints", [](SceneOptions& o) { o.hasOtherTopologies = o.hasOpaque = true; }},
    {"Planes", [](SceneOptions& o) { o.hasPlanes = o.hasOtherTopologies = true; }},
    {"Vertices", [](SceneOptions& o) { o.hasOddVertices = o.hasPlanes = o.hasOtherTopologies = true; }},
    {"Clipped", [](SceneOptions& o) { o.isClipped = o.hasOpaque = true; }},
    {"SampleColors", [](SceneOptions& o) { o.hasSampleColors = o.samples > 1; }},
    {"OneColumn",
     [](SceneOptions& o) {
       o.width = 3;
       o.height = 131;
     }},
    {"OneRow",
     [](SceneOptions& o) {
       o.width = 97;
       o.height = 3;
     }},
};

INSTANTIATE_TEST_SUITE_P(Features, BlendingTest, testing::ValuesIn(kFeatures),
                         [](const auto& given) { return std::string(given.param.name); });

SceneOptions randomOptions(Random& random) {
  const auto maybe = [&random] { return random.below(2) == 0; };
  SceneOptions options;
  options.width = 1 + random.below(80);
  options.height = 1 + random.below(80);
  options.samples = 1U << random.below(4);
  options.draws = 1 + random.below(12);
  options.clipSpace = static_cast<VitrailCpuClipSpace>(random.below(3));
  options.depthOrder = static_cast<VitrailDepthOrder>(random.below(2));
  options.hasFilters = maybe();
  options.hasDiscards = maybe();
  options.hasOpaque = maybe();
  options.hasDepth = maybe();
  options.hasOtherTopologies = maybe();
  options.hasPlanes = maybe();
  options.hasCulling = maybe();
  options.hasOddVertices = maybe();
  options.isClipped = maybe();
  options.hasSampleColors = options.samples > 1 && maybe();
  return options;
}

TEST(BlendingOfEverythingTest, IsThatOfTheReference) {
  Counted counted;
  for (std::uint64_t seed = 1; seed <= 60 * std::uint64_t{roundsOfTests()}; ++seed) {
    Random random(seed);
    expectScene(counted, 1000 + seed, randomOptions(random), "a mixed scene");
  }
  EXPECT_LT(counted.undecided * 5, counted.pixels);
}

// ---- Parts of a picture

// Corners whose triangles reach out of the part have the same places as in the whole: the same bits.
TEST(PartsTest, AreThoseOfTheWholePicture) {
  Random random(8);
  for (const std::uint32_t samples : {1U, 4U}) {
    SceneOptions options;
    options.samples = samples;
    options.hasFilters = options.hasOtherTopologies = options.isClipped = options.hasOpaque = options.hasPlanes = true;
    options.hasDiscards = true; // by pixels of the picture
    Scene scene = randomScene(random, options);
    for (const VitrailCpuInstructions instructions : instructionsHere()) {
      Raster raster(instructions);
      const Drawn whole = draw(raster, scene);
      for (int i = 0; i < 12; ++i) {
        const std::uint32_t x = random.below(options.width);
        const std::uint32_t y = random.below(options.height);
        Scene part;
        part.frame = scene.frame;
        part.frame.width = 1 + random.below(options.width - x);
        part.frame.height = 1 + random.below(options.height - y);
        part.frame.pictureWidth = options.width;
        part.frame.pictureHeight = options.height;
        part.frame.originX = x;
        part.frame.originY = y;
        std::vector<float> expected;
        for (std::uint32_t row = y; row < y + part.frame.height; ++row) {
          const std::size_t first = (std::size_t{row} * options.width + x) * 4;
          const std::size_t last = first + std::size_t{part.frame.width} * 4;
          const auto at = [](const std::vector<float>& v, std::size_t place) {
            return v.begin() + static_cast<std::ptrdiff_t>(place);
          };
          part.background.insert(part.background.end(), at(scene.background, first), at(scene.background, last));
          expected.insert(expected.end(), at(whole.pixels, first), at(whole.pixels, last));
        }
        const Drawn drawn = draw(raster, part, scene.descs());
        EXPECT_TRUE(std::memcmp(drawn.pixels.data(), expected.data(), expected.size() * sizeof(float)) == 0)
            << part.frame.width << " x " << part.frame.height << " at " << x << ", " << y << ", " << samples
            << " samples, " << nameOf(instructions);
      }
    }
  }
}

// ---- One colour behind all draws

// `color` is not read: it holds no numbers. Tiles and blocks in which there is nothing are written, too.
TEST(ClearTest, IsThePictureOverThatColor) {
  Random random(12);
  for (int i = 0; i < 24; ++i) {
    SceneOptions options = randomOptions(random);
    options.hasSampleColors = false;
    Scene scene = randomScene(random, options);
    if (i % 4 == 0) scene.draws.clear();
    const std::array<float, 4> color = {random.single(0.0, 1.0), random.single(0.0, 1.0), 0.25F, 0.5F};
    for (std::size_t at = 0; at < scene.background.size(); ++at) scene.background[at] = color[at % 4];
    for (const VitrailCpuInstructions instructions : instructionsHere()) {
      Raster raster(instructions);
      const Drawn filled = draw(raster, scene);
      Scene cleared;
      cleared.frame = scene.frame;
      cleared.frame.clear = color.data();
      cleared.depth = scene.depth;
      cleared.background.assign(scene.background.size(), std::numeric_limits<float>::quiet_NaN());
      EXPECT_TRUE(draw(raster, cleared, scene.descs()) == filled) << "scene " << i << ", " << nameOf(instructions);
    }
  }
}

TEST(ClearTest, OfEightBitsTakesNoAlpha) {
  Random random(13);
  SceneOptions options;
  options.hasOpaque = true;
  const Scene scene = randomScene(random, options);
  Raster raster(VITRAIL_CPU_BEST);
  const auto drawOver = [&](std::uint8_t held, const float* clear) {
    std::vector<std::uint8_t> bytes(std::size_t{options.width} * options.height * 4, held);
    VitrailCpuFrame frame = scene.frame;
    frame.colorFormat = VITRAIL_CPU_RGBA8_SRGB;
    frame.color = bytes.data();
    frame.clear = clear;
    EXPECT_EQ(raster.render(frame, scene.descs()), VITRAIL_SUCCESS);
    return bytes;
  };
  const std::array<float, 4> white = {1.0F, 1.0F, 1.0F, 0.0F};
  std::vector<std::uint8_t> filled = drawOver(255, nullptr);
  EXPECT_EQ(drawOver(77, white.data()), filled);
  EXPECT_NE(drawOver(77, nullptr), filled);
}

// ---- Rows of the host's arrays

TEST(StridesTest, KeepOffWhatIsBetweenRows) {
  Random random(9);
  SceneOptions options;
  options.hasOpaque = options.hasDepth = true;
  options.samples = 2;
  const Scene scene = randomScene(random, options);
  Raster raster(VITRAIL_CPU_BEST);
  const Drawn plain = draw(raster, scene);
  const std::size_t colorRow = std::size_t{options.width} * 4 + 3;
  const std::size_t depthRow = std::size_t{options.width} * 2 + 1;
  std::vector<float> color(colorRow * options.height, -7.0F);
  std::vector<float> depth(depthRow * options.height, -7.0F);
  for (std::size_t y = 0; y < options.height; ++y) {
    std::copy_n(&scene.background[y * options.width * 4], options.width * 4, &color[y * colorRow]);
    std::copy_n(&scene.depth[y * options.width * 2], options.width * 2, &depth[y * depthRow]);
  }
  VitrailCpuFrame frame = scene.frame;
  frame.color = color.data();
  frame.colorStride = static_cast<std::uint32_t>(colorRow * sizeof(float));
  frame.depth = depth.data();
  frame.depthStride = static_cast<std::uint32_t>(depthRow * sizeof(float));
  ASSERT_EQ(raster.render(frame, scene.descs()), VITRAIL_SUCCESS);
  for (std::size_t y = 0; y < options.height; ++y) {
    EXPECT_TRUE(std::equal(&color[y * colorRow], &color[y * colorRow] + options.width * 4,
                           &plain.pixels[y * options.width * 4]));
    EXPECT_TRUE(std::equal(&depth[y * depthRow], &depth[y * depthRow] + options.width * 2,
                           &plain.depth[y * options.width * 2]));
    for (std::size_t i = options.width * 4; i < colorRow; ++i) EXPECT_EQ(color[y * colorRow + i], -7.0F);
    for (std::size_t i = options.width * 2; i < depthRow; ++i) EXPECT_EQ(depth[y * depthRow + i], -7.0F);
  }
}

// ---- sRGB

long double exactSrgb(long double v) {
  return v <= 0.0031308L ? 12.92L * v : 1.055L * std::pow(v, 1.0L / 2.4L) - 0.055L;
}

// A row of opaque colours, which become codes without anything between.
TEST(SrgbTest, RoundsToTheNearestCode) {
  constexpr std::uint32_t kWidth = 4096;
  Random random(10);
  std::vector<float> values;
  for (int code = 0; code < 255; ++code) { // around each border between two codes
    long double low = 0.0L;
    long double high = 1.0L;
    for (int i = 0; i < 80; ++i) {
      const long double middle = (low + high) / 2.0L;
      (exactSrgb(middle) * 255.0L < code + 0.5L ? low : high) = middle;
    }
    const auto border = static_cast<float>(low);
    const float below = std::nextafterf(border, 0.0F);
    const float above = std::nextafterf(border, 1.0F);
    values.insert(values.end(), {std::nextafterf(below, 0.0F), below, border, above, std::nextafterf(above, 1.0F)});
  }
  values.insert(values.end(), {0.0F, 1e-30F, 1.0F, 2.0F, 65504.0F, INFINITY, -1.0F, NAN, 0.9999999F});
  while (values.size() < kWidth) values.push_back(random.single(0.0, 1.0));
  const std::vector<Position> corners{{-1.0F, -1.0F, 0.5F, 1.0F}, {3.0F, -1.0F, 0.5F, 1.0F}, {-1.0F, 3.0F, 0.5F, 1.0F}};
  VitrailCpuDraw triangle = drawOf(corners);
  triangle.surface = VITRAIL_CPU_OPAQUE;
  triangle.shade = [](void* user, VitrailCpuFragments* f) {
    for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
      const std::size_t x = std::min<std::size_t>(f->x + i % 4, kWidth - 1);
      for (std::size_t c = 0; c < 3; ++c) f->color[c][i] = static_cast<const float*>(user)[(x + c) % kWidth];
      f->color[3][i] = 0.5F;
    }
  };
  triangle.shadeUser = values.data();
  std::vector<std::uint8_t> pixels(std::size_t{kWidth} * 4, 77);
  VitrailCpuFrame frame{};
  frame.width = kWidth;
  frame.height = 1;
  frame.colorFormat = VITRAIL_CPU_RGBA8_SRGB;
  frame.color = pixels.data();
  Raster raster(VITRAIL_CPU_BEST);
  ASSERT_EQ(raster.render(frame, {&triangle, 1}), VITRAIL_SUCCESS);
  for (std::size_t x = 0; x < kWidth; ++x) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = values[(x + c) % kWidth];
      const long double clamped = v > 0.0F ? std::min(v, 1.0F) : 0.0F;
      const long double steps = exactSrgb(clamped) * 255.0L;
      // Where the border itself is no float, one of its neighbours is as near as rounding of the border lets it be.
      EXPECT_NEAR(static_cast<double>(steps), pixels[4 * x + c], 0.5 + 1e-5) << v;
    }
    EXPECT_EQ(pixels[4 * x + 3], 255) << x;
  }
}

// Blended in linear light and rounded once; codes of pixels that nothing touches stay.
TEST(SrgbTest, PicturesAreThoseOfTheReference) {
  for (const std::uint32_t samples : {1U, 4U}) {
    Random random(11);
    SceneOptions options;
    options.samples = samples;
    options.hasOpaque = options.hasFilters = true;
    Scene scene = randomScene(random, options);
    std::vector<std::uint8_t> codes(scene.background.size());
    for (std::size_t i = 0; i < codes.size(); ++i) {
      codes[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(random.below(256));
      scene.background[i] = i % 4 == 3 ? 1.0F : static_cast<float>(srgbToLinear(codes[i] / 255.0));
    }
    const Expected expected = expectedOf(scene);
    const std::vector<std::uint8_t> before = codes;
    VitrailCpuFrame frame = scene.frame;
    frame.colorFormat = VITRAIL_CPU_RGBA8_SRGB;
    frame.color = codes.data();
    Raster raster(VITRAIL_CPU_BEST);
    ASSERT_EQ(raster.render(frame, scene.descs()), VITRAIL_SUCCESS);
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
      if (expected.isUndecided[i]) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const double steps = 255.0 * linearToSrgb(std::clamp(expected.pixels[i][c], 0.0, 1.0));
        ASSERT_NEAR(steps, codes[4 * i + c], 0.5 + 0.05 + 0.01 + 3300.0 * expected.noise[i]) << "pixel " << i;
        const bool isUntouched = expected.pixels[i][c] == double{scene.background[4 * i + c]};
        ASSERT_TRUE(!isUntouched || codes[4 * i + c] == before[4 * i + c]) << "pixel " << i;
      }
      ASSERT_EQ(codes[4 * i + 3], 255);
    }
  }
}

} // namespace
} // namespace vitrail::tests::raster
