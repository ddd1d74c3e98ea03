// What a resolve must compute, in double precision: sort the fragments of a pixel, blend them and average the samples.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "node.h"

namespace vitrail {

// What fragments do to the light behind them, channel by channel (r, g, b, and the picture's alpha): `d` becomes
// color + transmittance * d. Linear, premultiplied.
struct Blended {
  Color color{};
  Color transmittance{1.0, 1.0, 1.0, 1.0};
};

// One stored fragment as such a pair (VitrailBlend states them).
Blended blendOf(const Fragment& stored);

// `front` before `behind`: again a pair (Porter and Duff 1984).
Blended compose(const Blended& front, const Blended& behind);

Color over(const Blended& front, const Color& behind);

// A pixel as the resolve finds it.
struct PixelList {
  NodeCoding coding;
  std::vector<NodeWords> nodes; // in any order
  // Without post-depth coverage: the opaque depth of each sample, which hides the fragments behind it. A fragment that
  // is as deep passes, in the resolution that the node format stores. Empty: coverage has passed the depth test.
  std::span<const float> opaqueDepth;
  std::uint32_t maxLayers = 0; // 0: no bound
};

// Blends the fragments that cover a sample, front to back. With a bound, all but the pixel's nearest `maxLayers` are
// blended under those as their weighted average.
Blended resolveSample(const PixelList& pixel, std::uint32_t sample);

// The pixel over the samples' opaque colours: the mean of all samples (a box filter).
Color resolvePixel(const PixelList& pixel, std::span<const Color> behind);

// Fragments blended without regard to their order, after Bavoil and Myers, "Order Independent Transparency with Dual
// Depth Peeling" (2008), extended to the other blend modes: colour S * (A > 0 ? (1 - Ta) / A : 1) and transmittance T,
// where S adds up what each fragment adds, A the alphas of those with a body (over and premultiplied), Ta is the
// product of their 1 - alpha and T that of all transmittances.
Blended weightedAverage(std::span<const Fragment> stored);

} // namespace vitrail
