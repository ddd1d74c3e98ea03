// Image metrics against closed forms, and against numbers worked out by other programs: scikit-image 0.19.3 for SSIM
// (gaussian_weights, sigma 1.5, use_sample_covariance off, data_range 255, on the same luma), and for FLIP a program of
// its own in float64 that sums every filter over its whole square, written from the paper's formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "image/color_map.h"
#include "image/metrics.h"
#include "image/ssim.h"

namespace vitrail::tests {
namespace {

using namespace vitrail::tool;
using Rgb = std::array<std::uint8_t, 3>;

Picture pictureOf(std::uint32_t width, std::uint32_t height,
                  const std::function<Rgb(std::uint32_t x, std::uint32_t y)>& color) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const Rgb c = color(x, y);
      picture.rgba.insert(picture.rgba.end(), {c[0], c[1], c[2], 255});
    }
  }
  return picture;
}

Picture filled(std::uint32_t width, std::uint32_t height, Rgb color) {
  return pictureOf(width, height, [color](std::uint32_t, std::uint32_t) { return color; });
}

constexpr std::uint32_t kWidth = 48;
constexpr std::uint32_t kHeight = 40;

Rgb waveAt(std::uint32_t x, std::uint32_t y) {
  return {static_cast<std::uint8_t>(x * 5), static_cast<std::uint8_t>(y * 7), static_cast<std::uint8_t>((x + y) * 3)};
}
Picture waves() { return pictureOf(kWidth, kHeight, waveAt); }

// A step from dark to light grey at column `at`.
Picture step(std::uint32_t at) {
  return pictureOf(kWidth, kHeight, [at](std::uint32_t x, std::uint32_t) {
    return x < at ? Rgb{64, 64, 64} : Rgb{192, 192, 192};
  });
}

std::uint32_t scrambled(std::uint32_t i) {
  i *= 2654435761U;
  i ^= i >> 15U;
  i *= 2246822519U;
  return i ^ i >> 13U;
}

Picture noise(std::uint32_t width, std::uint32_t height, std::uint32_t seed) {
  return pictureOf(width, height, [=](std::uint32_t x, std::uint32_t y) {
    Rgb color{};
    for (std::uint32_t c = 0; c < 3; ++c) {
      color[c] = static_cast<std::uint8_t>(scrambled((y * width + x) * 3 + c + seed * 1000003U) >> 24U);
    }
    return color;
  });
}

Difference between(const Picture& a, const Picture& b) { return ComparedPicture(a).differenceTo(b); }

double largest(const Plane& plane) { return *std::ranges::max_element(plane.values); }

TEST(Metrics, EqualPicturesDoNotDiffer) {
  for (const Picture& picture :
       {waves(), noise(kWidth, kHeight, 1), filled(1, 1, {7, 8, 9}), filled(3, 30, {0, 0, 0})}) {
    const Difference difference = between(picture, picture);
    EXPECT_TRUE(std::isinf(difference.metrics.psnr));
    EXPECT_NEAR(difference.metrics.ssim, 1.0, 1e-12);
    EXPECT_EQ(difference.metrics.flip, 0.0);
    EXPECT_EQ(largest(difference.flip), 0.0);
    EXPECT_EQ(difference.metrics.worst, 0);
    EXPECT_EQ(difference.metrics.offShare, 0.0);
  }
}

TEST(Metrics, PsnrByHand) {
  // Every value is off by 5: 20 log10(255 / 5).
  EXPECT_NEAR(between(filled(20, 20, {100, 100, 100}), filled(20, 20, {105, 95, 105})).metrics.psnr, 34.151403, 1e-6);
  EXPECT_NEAR(between(filled(9, 9, {0, 0, 0}), filled(9, 9, {255, 255, 255})).metrics.psnr, 0.0, 1e-12);
  // One channel of three is off by 255: 10 log10(3).
  EXPECT_NEAR(between(filled(9, 9, {0, 0, 0}), filled(9, 9, {0, 255, 0})).metrics.psnr, 4.771213, 1e-6);
  // One channel of one pixel in 100 is off by 51: 10 log10(255^2 * 300 / 51^2).
  Picture spot = filled(10, 10, {50, 50, 50});
  spot.rgba[4 * 37 + 2] = 101;
  EXPECT_NEAR(between(filled(10, 10, {50, 50, 50}), spot).metrics.psnr, 38.750613, 1e-6);
}

// Without variance SSIM is (2 a b + C1) / (a^2 + b^2 + C1), C1 = 6.5025.
TEST(Metrics, SsimOfConstantPicturesByHand) {
  EXPECT_NEAR(ssim(filled(16, 16, {0, 0, 0}), filled(16, 16, {255, 255, 255})), 6.5025 / (65025.0 + 6.5025), 1e-9);
  EXPECT_NEAR(ssim(filled(16, 16, {100, 100, 100}), filled(16, 16, {120, 120, 120})), 24006.5025 / 24406.5025, 1e-9);
  // Luma weighs the channels: a red of 200 is 59.8, a blue of 100 is 11.4.
  EXPECT_NEAR(ssim(filled(16, 16, {200, 0, 0}), filled(16, 16, {0, 0, 100})),
              (2 * 59.8 * 11.4 + 6.5025) / (59.8 * 59.8 + 11.4 * 11.4 + 6.5025), 1e-9);
  // Smaller than the window.
  EXPECT_NEAR(ssim(filled(4, 7, {100, 100, 100}), filled(4, 7, {120, 120, 120})), 24006.5025 / 24406.5025, 1e-9);
}

// A 1x1 picture has no variance at all; in a 3x1 picture the window has weights w, 1 - 2w, w.
TEST(Metrics, SsimOfThreePixelsByHand) {
  const Picture a = pictureOf(3, 1, [](std::uint32_t x, std::uint32_t) { return x == 1 ? Rgb{90, 90, 90} : Rgb{}; });
  const Picture b = filled(3, 1, {30, 30, 30});
  const double side = std::exp(-1.0 / 4.5);
  const double middle = 1.0 / (1.0 + 2.0 * side);
  const double mean = 90.0 * middle;
  const double variance = 8100.0 * middle - mean * mean;
  const double expected =
      (2.0 * mean * 30.0 + 6.5025) * 58.5225 / ((mean * mean + 900.0 + 6.5025) * (variance + 58.5225));
  EXPECT_NEAR(ssim(a, b), expected, 1e-9);
}

// The colour of constant pictures passes the filters unchanged, and there are no features.
TEST(Metrics, FlipOfConstantPicturesByHand) {
  // sRGB's green and blue have L*a*b* (87.735, -86.183, 83.180) and (32.297, 79.188, -107.860). Hunt's effect makes a*
  // and b* (-75.613, 72.978) and (25.575, -34.836); the distance is 55.438 + |(101.188, 107.814)| = 203.299.
  const double largestError = std::pow(203.299, 0.7);
  const double bound = 0.4 * largestError;
  // Black and white: L* differs by 100, which lies beyond the knee.
  const double expected = 0.95 + (std::pow(100.0, 0.7) - bound) / (largestError - bound) * 0.05;
  EXPECT_NEAR(between(filled(8, 8, {0, 0, 0}), filled(8, 8, {255, 255, 255})).metrics.flip, expected, 1e-5);
  EXPECT_NEAR(between(filled(8, 8, {0, 255, 0}), filled(8, 8, {0, 0, 255})).metrics.flip, 1.0, 1e-9);
  // Greys 119 and 124: L* 50.034 and 52.014, which lies below it.
  EXPECT_NEAR(between(filled(8, 8, {119, 119, 119}), filled(8, 8, {124, 124, 124})).metrics.flip,
              0.95 * std::pow(1.9801, 0.7) / bound, 2e-4);
}

struct Expected {
  const char* name;
  Picture a;
  Picture b;
  double psnr;
  double ssim;
  double flip;
  double flipLargest;
  double flipAt35; // at (3, 5)
};

// The same, with one pixel changed to white.
Picture wavesWithSpot() {
  Picture picture = waves();
  std::fill_n(picture.rgba.begin() + 4 * (20 * kWidth + 24), 4, std::uint8_t{255});
  return picture;
}

TEST(Metrics, AsOtherProgramsHaveIt) {
  const Picture shifted =
      pictureOf(kWidth, kHeight, [](std::uint32_t x, std::uint32_t y) { return waveAt((x + kWidth - 1) % kWidth, y); });
  const Picture dimmed = pictureOf(kWidth, kHeight, [](std::uint32_t x, std::uint32_t y) {
    Rgb color = waveAt(x, y);
    for (std::uint8_t& c : color) c = static_cast<std::uint8_t>(c * 3 / 4);
    return color;
  });
  const std::vector<Expected> cases = {
      {"shifted", waves(), shifted, 20.785828, 0.99866319, 0.14484348, 0.97299825, 0.21156812},
      {"spot", waves(), wavesWithSpot(), 39.053127, 0.97513511, 0.00214531, 0.34096219, 0.0},
      {"step", step(24), step(26), 19.788717, 0.77884425, 0.07040807, 0.75428629, 0.0},
      {"dimmed", waves(), dimmed, 17.227233, 0.93537608, 0.56337195, 0.87704510, 0.21313907},
      {"noise", noise(kWidth, kHeight, 1), noise(kWidth, kHeight, 2), 7.602029, 0.00422806, 0.45597551, 0.92212108,
       0.58095566},
      {"small", noise(20, 12, 3), noise(20, 12, 4), 7.534968, 0.20517472, 0.52048250, 0.96402639, 0.70605027},
  };
  for (const Expected& expected : cases) {
    SCOPED_TRACE(expected.name);
    const Difference difference = between(expected.a, expected.b);
    EXPECT_NEAR(difference.metrics.psnr, expected.psnr, 1e-5);
    EXPECT_NEAR(difference.metrics.ssim, expected.ssim, 1e-7);
    EXPECT_NEAR(difference.metrics.flip, expected.flip, 1e-6);
    EXPECT_NEAR(largest(difference.flip), expected.flipLargest, 1e-6);
    EXPECT_NEAR(difference.flip.values[5 * expected.a.width + 3], expected.flipAt35, 1e-6);
    const Difference reversed = between(expected.b, expected.a);
    EXPECT_EQ(reversed.metrics.psnr, difference.metrics.psnr);
    EXPECT_NEAR(reversed.metrics.ssim, difference.metrics.ssim, 1e-12);
    EXPECT_NEAR(reversed.metrics.flip, difference.metrics.flip, 1e-12);
  }
}

TEST(Metrics, TheWorstPixelAndTheShareThatIsOff) {
  const Picture base = filled(10, 10, {100, 100, 100});
  Picture other = base;
  other.rgba[4 * 12 + 0] = 102; // (2, 1): at the bound
  other.rgba[4 * 34 + 1] = 97;  // (4, 3): beyond it
  other.rgba[4 * 56 + 2] = 140; // (6, 5): the worst
  other.rgba[4 * 78 + 0] = 60;  // (8, 7): as bad, later
  const Metrics metrics = between(base, other).metrics;
  EXPECT_EQ(metrics.worst, 40);
  EXPECT_EQ(metrics.worstX, 6U);
  EXPECT_EQ(metrics.worstY, 5U);
  EXPECT_DOUBLE_EQ(metrics.offShare, 0.03);
}

Picture withAlpha(Rgb color, std::uint8_t alpha) {
  Picture picture = filled(8, 8, color);
  picture.hasAlpha = true;
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = alpha;
  return picture;
}

TEST(Metrics, AlphaIsSeenOverBlackAndOverWhite) {
  // White that is not there is seen as the backdrop: over black it differs from opaque white by everything.
  const Metrics missing = between(filled(8, 8, {255, 255, 255}), withAlpha({255, 255, 255}, 0)).metrics;
  EXPECT_EQ(missing.worst, 255);
  EXPECT_NEAR(missing.psnr, 0.0, 1e-12);
  EXPECT_NEAR(missing.flip, 0.96737976, 1e-6);
  EXPECT_EQ(missing.offShare, 1.0);
  // And so does black that is not there, over white.
  EXPECT_EQ(between(filled(8, 8, {0, 0, 0}), withAlpha({0, 0, 0}, 0)).metrics.worst, 255);
  // Colours without alpha are not seen.
  EXPECT_TRUE(std::isinf(between(withAlpha({255, 0, 0}, 0), withAlpha({0, 0, 255}, 0)).metrics.psnr));
  // Half of white in linear light, 128 / 255 = 0.50196, is code 188 over black.
  const Metrics half = between(filled(8, 8, {188, 188, 188}), withAlpha({255, 255, 255}, 128)).metrics;
  EXPECT_EQ(half.worst, 67); // over white it is white
  Picture grey = withAlpha({188, 188, 188}, 255);
  grey.hasAlpha = false;
  EXPECT_EQ(between(grey, filled(8, 8, {188, 188, 188})).metrics.worst, 0);
}

TEST(Metrics, DifferentSizesAreRefused) {
  const ComparedPicture compared(filled(4, 5, {0, 0, 0}));
  EXPECT_THROW(compared.differenceTo(filled(5, 4, {0, 0, 0})), std::invalid_argument);
}

TEST(ColorMap, EndsAndMiddle) {
  Plane plane(4, 1);
  plane.values = {0.0, 5.0, 10.0, 12.0};
  const Picture map = heatmap(plane, 10.0, kMagma);
  EXPECT_EQ(map.rgba,
            (std::vector<std::uint8_t>{0, 0, 4, 255, 183, 55, 121, 255, 252, 253, 191, 255, 252, 253, 191, 255}));
  plane.values = {0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(heatmap(plane, 0.0, kViridis).rgba[0], 68);
  // A value between two colours lies between them.
  plane.values = {1.0 / 32.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(heatmap(plane, 1.0, kMagma).rgba[0], 5);
}

} // namespace
} // namespace vitrail::tests
