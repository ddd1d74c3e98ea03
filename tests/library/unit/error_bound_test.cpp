// The stated bound on rounding, against lists that were made to be rounded as badly as can be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "../reference/node.h"
#include "vitrail/types.h"

namespace vitrail::tests {
namespace {

struct Layer {
  double color;
  double alpha;
};

double blend(const std::vector<Layer>& layers, double behind) {
  for (std::size_t i = layers.size(); i-- > 0;) {
    behind = layers[i].alpha * layers[i].color + (1.0 - layers[i].alpha) * behind;
  }
  return behind;
}

std::vector<Layer> stored(std::vector<Layer> layers, std::uint32_t format) {
  NodeCoding coding;
  coding.format = format;
  for (Layer& layer : layers) {
    const auto node = packNode(coding, {{layer.color, layer.color, layer.color, layer.alpha}, 0.5F});
    if (!node) layer.alpha = 0.0; // it is not stored
    if (!node) continue;
    const Fragment kept = unpackNode(coding, *node);
    layer = {kept.color[1], kept.color[3]};
  }
  return layers;
}

// Steps of an 8-bit picture between the real-number answer and what is stored, the picture's own half step included.
double errorOf(const std::vector<Layer>& layers, double behind, std::uint32_t format) {
  const auto shown = [](double linear) { return 255.0 * linearToSrgb(std::clamp(linear, 0.0, 1.0)); };
  return std::abs(shown(blend(layers, behind)) - shown(blend(stored(layers, format), behind))) + 0.5;
}

// An alpha near `a` that the format rounds up by (nearly) half a step, or down.
double badlyRounded(double a, std::uint32_t format, bool up) {
  const double nudge = up ? 1e-6 : -1e-6;
  if (format == layout::VITRAIL_FORMAT_HDR) {
    const double root = (std::floor(std::sqrt(a) * 65535.0) + 0.5 + nudge) / 65535.0;
    return root * root;
  }
  return (std::floor(a * 255.0) + 0.5 + nudge) / 255.0;
}

// The worst error found among lists of n layers.
double worstOf(std::uint32_t n, std::uint32_t format) {
  std::mt19937 random(n);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const std::vector<std::function<double(std::uint32_t)>> colors{
      [](std::uint32_t) { return 1.0; },
      [](std::uint32_t) { return 0.0; },
      [](std::uint32_t i) { return i % 2 == 0 ? 1.0 : 0.0; },
      [n](std::uint32_t i) { return 2 * i < n ? 0.0 : 1.0; },
      [n](std::uint32_t i) { return 2 * i < n ? 1.0 : 0.0; },
      [&](std::uint32_t) { return unit(random); },
  };
  double worst = 0.0;
  std::vector<Layer> layers(n);
  for (double a = 1e-7; a < 1.0; a *= 1.7) {
    for (const auto& color : colors) {
      for (const int rounding : {0, 1, 2}) { // all down, all up, as it comes
        for (std::uint32_t i = 0; i < n; ++i) {
          layers[i] = {color(i), rounding < 2 ? badlyRounded(a, format, rounding == 1) : a * (0.5 + unit(random))};
          layers[i].alpha = std::min(layers[i].alpha, 1.0);
        }
        for (const double behind : {0.0, 0.003, 0.2, 1.0}) worst = std::max(worst, errorOf(layers, behind, format));
      }
    }
  }
  return worst;
}

TEST(ErrorBound, HoldsForListsThatAreRoundedBadly) {
  for (const std::uint32_t n : {1U, 2U, 7U, 30U, 300U, 2000U}) {
    const double hdr = worstOf(n, layout::VITRAIL_FORMAT_HDR);
    EXPECT_LE(hdr, vitrailNodeErrorBound(VITRAIL_NODE_HDR, 1, n)) << n << " layers";
    EXPECT_LE(hdr, 1.0) << n << " layers";
    const double standard = worstOf(n, layout::VITRAIL_FORMAT_STANDARD);
    EXPECT_LE(standard, vitrailNodeErrorBound(VITRAIL_NODE_STANDARD, 1, n)) << n << " layers";
    EXPECT_GT(standard, n == 1 ? 4.0 : 6.0) << "8 bits of alpha are not enough";
  }
}

TEST(ErrorBound, IsAtMostOneForAllThatIsCalledExact) {
  EXPECT_LE(vitrailNodeErrorBound(VITRAIL_NODE_HDR, 1, 3900), 1.0F);
  EXPECT_LE(vitrailNodeErrorBound(VITRAIL_NODE_HDR, 8, 3900), 1.0F);
  EXPECT_GT(vitrailNodeErrorBound(VITRAIL_NODE_HDR, 1, 4000), 1.0F);
  EXPECT_EQ(vitrailNodeErrorBound(VITRAIL_NODE_HDR, 1, 0), 0.5F) << "an empty frame is exact";
  for (const auto format : {VITRAIL_NODE_STANDARD, VITRAIL_NODE_COMPACT}) {
    EXPECT_EQ(vitrailNodeErrorBound(format, 1, 0), vitrailNodeErrorBound(format, 1, 1)) << "one may be lost";
  }
  EXPECT_NEAR(vitrailNodeErrorBound(VITRAIL_NODE_STANDARD, 1, 1), 1.0 + 255.0 * 12.92 * 0.5 / 255.0, 1e-4);
  EXPECT_GT(vitrailNodeErrorBound(VITRAIL_NODE_COMPACT, 4, 1), vitrailNodeErrorBound(VITRAIL_NODE_COMPACT, 1, 1));
  EXPECT_EQ(vitrailNodeErrorBound(VITRAIL_NODE_COMPACT, 8, 1), 255.0F) << "there are no such targets";
  EXPECT_EQ(vitrailNodeErrorBound(static_cast<VitrailNodeFormat>(9), 1, 1), 255.0F);
}

} // namespace
} // namespace vitrail::tests
