// The reference resolve, against values worked out by hand.
#include <gtest/gtest.h>

#include <array>
#include <span>
#include <vector>

#include "../reference/resolve.h"

namespace vitrail::tests {
namespace {

using namespace layout;

NodeWords node(const NodeCoding& coding, const Fragment& fragment) { return packNode(coding, fragment).value(); }

void expectColor(const Color& got, const Color& expected) {
  for (unsigned i = 0; i < 4; ++i) EXPECT_NEAR(got[i], expected[i], 1e-12) << "channel " << i;
}

TEST(ReferenceResolve, TwoLayersByHand) {
  // Half red at 0.25 in front of half green at 0.75 over blue: 128/255 is the stored half.
  const double a = 128.0 / 255.0;
  const std::array<Color, 1> blue = {Color{0.0, 0.0, 1.0, 1.0}};
  for (const bool nearestIsOne : {false, true}) {
    PixelList pixel;
    pixel.coding.nearestIsOne = nearestIsOne;
    const NodeWords red = node(pixel.coding, {{1.0, 0.0, 0.0, 0.5}, 0.25F});
    const NodeWords green = node(pixel.coding, {{0.0, 1.0, 0.0, 0.5}, 0.75F});
    for (const auto& list : {std::vector{red, green}, std::vector{green, red}}) {
      pixel.nodes = list;
      const double front = a;
      const double back = (1 - a) * a;
      expectColor(resolvePixel(pixel, blue),
                  {nearestIsOne ? back : front, nearestIsOne ? front : back, (1 - a) * (1 - a), 1.0});
    }
  }
}

TEST(ReferenceResolve, NothingChangesNothing) {
  const std::array<Color, 1> behind = {Color{0.1, 0.2, 0.3, 0.4}};
  expectColor(resolvePixel({}, behind), behind[0]);
}

// hdr at alpha 1/9, the square of 21845/65535, which 16 bits hold exactly.
TEST(ReferenceResolve, EveryBlendModeByHand) {
  const double a = 1.0 / 9.0;
  const double t = 8.0 / 9.0;
  const Color d = {0.5, 0.25, 1.0, 0.75};
  const auto resolve = [&](std::uint32_t blend) {
    PixelList pixel;
    pixel.coding.format = VITRAIL_FORMAT_HDR;
    pixel.nodes = {node(pixel.coding, {{4.0, 0.5, 0.0, a}, 0.5F, blend, 1})};
    return resolvePixel(pixel, std::span(&d, 1));
  };
  expectColor(resolve(VITRAIL_OVER), {4 * a + d[0] * t, 0.5 * a + d[1] * t, d[2] * t, a + d[3] * t});
  expectColor(resolve(VITRAIL_PREMULTIPLIED), {4 + d[0] * t, 0.5 + d[1] * t, d[2] * t, a + d[3] * t});
  expectColor(resolve(VITRAIL_ADDITIVE), {4 * a + d[0], 0.5 * a + d[1], d[2], d[3]});
  expectColor(resolve(VITRAIL_MULTIPLY), {(t + 4 * a) * d[0], (t + 0.5 * a) * d[1], t * d[2], d[3]});
}

TEST(ReferenceResolve, EachSampleBlendsWhatCoversIt) {
  PixelList pixel;
  pixel.coding.samples = 4;
  const Fragment red = {{1.0, 0.0, 0.0, 1.0}, 0.2F, VITRAIL_OVER, 0x3};
  const Fragment green = {{0.0, 1.0, 0.0, 1.0}, 0.6F, VITRAIL_OVER, 0x6};
  pixel.nodes = {node(pixel.coding, green), node(pixel.coding, red)};
  const std::array<Color, 4> behind = {Color{}, Color{}, Color{}, Color{0.0, 0.0, 1.0, 1.0}};
  expectColor(resolvePixel(pixel, behind), {0.5, 0.25, 0.25, 1.0});
  // The opaque depth hides red nowhere, green where it is nearer than it, not where it is as near.
  const std::array<float, 4> opaque = {0.2F, 0.3F, 0.6F, 0.0F};
  pixel.opaqueDepth = opaque;
  expectColor(resolvePixel(pixel, behind), {0.5, 0.25, 0.25, 1.0});
  const std::array<float, 4> nearer = {0.2F, 0.1F, 0.5999F, 0.0F};
  pixel.opaqueDepth = nearer;
  expectColor(resolvePixel(pixel, behind), {0.25, 0.0, 0.25, 0.5});
}

// A bound of one: the second and the third layer become their weighted average, with the right transmittance.
TEST(ReferenceResolve, LayersBeyondTheBoundAreAveraged) {
  PixelList pixel;
  pixel.coding.format = VITRAIL_FORMAT_HDR;
  const double a = 1.0 / 9.0; // and 1/25: squares of what 16 bits hold exactly
  const double t = 8.0 / 9.0;
  pixel.nodes = {node(pixel.coding, {{0.0, 0.0, 1.0, 1.0 / 25.0}, 0.9F}),
                 node(pixel.coding, {{0.0, 1.0, 0.0, a}, 0.8F}), node(pixel.coding, {{1.0, 0.0, 0.0, a}, 0.1F})};
  const Blended exact = resolveSample(pixel, 0);
  expectColor(exact.color, {a, t * a, t * t / 25, 1 - t * t * 24 / 25});
  pixel.maxLayers = 1;
  const Blended bounded = resolveSample(pixel, 0);
  const double opacity = 1 - t * 24 / 25;
  const double share = opacity / (1.0 / 9 + 1.0 / 25);
  expectColor(bounded.color, {a, t * share / 9, t * share / 25, 1 - t * t * 24 / 25});
  expectColor(bounded.transmittance, exact.transmittance);
  pixel.maxLayers = 3;
  expectColor(resolveSample(pixel, 0).color, exact.color);
  pixel.maxLayers = 2; // the last one alone is its own average
  expectColor(resolveSample(pixel, 0).color, exact.color);
}

TEST(ReferenceResolve, TheAverageOfOtherModes) {
  const std::array<Fragment, 2> lights = {Fragment{{1.0, 0.0, 0.0, 0.5}, 0.0F, VITRAIL_ADDITIVE, 1},
                                          Fragment{{0.0, 1.0, 0.0, 1.0}, 0.0F, VITRAIL_MULTIPLY, 1}};
  const Blended sum = weightedAverage(lights);
  expectColor(sum.color, {0.5, 0.0, 0.0, 0.0});
  expectColor(sum.transmittance, {0.0, 1.0, 0.0, 1.0});
}

} // namespace
} // namespace vitrail::tests
