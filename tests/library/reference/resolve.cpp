#include "resolve.h"

#include <algorithm>
#include <utility>

namespace vitrail {

namespace {

// The pixel's stored fragments, nearest first.
std::vector<Fragment> sorted(const PixelList& pixel) {
  std::vector<std::pair<SortKey, Fragment>> keyed;
  keyed.reserve(pixel.nodes.size());
  for (const NodeWords& words : pixel.nodes) {
    keyed.emplace_back(sortKey(pixel.coding, words), unpackNode(pixel.coding, words));
  }
  std::sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Fragment> fragments;
  fragments.reserve(keyed.size());
  for (const auto& [key, fragment] : keyed) fragments.push_back(fragment);
  return fragments;
}

bool isSeen(const PixelList& pixel, const Fragment& fragment, std::uint32_t sample) {
  if ((fragment.coverage >> sample & 1U) == 0) return false;
  return pixel.opaqueDepth.empty() ||
         depthKey(pixel.coding, fragment.depth) <= depthKey(pixel.coding, pixel.opaqueDepth[sample]);
}

// Blends one sample from the pixel's sorted fragments.
Blended resolveSorted(const PixelList& pixel, std::span<const Fragment> fragments, std::uint32_t sample) {
  const std::size_t kept =
      pixel.maxLayers == 0 ? fragments.size() : std::min<std::size_t>(pixel.maxLayers, fragments.size());
  Blended result;
  for (const Fragment& fragment : fragments.first(kept)) {
    if (isSeen(pixel, fragment, sample)) result = compose(result, blendOf(fragment));
  }
  std::vector<Fragment> tail;
  for (const Fragment& fragment : fragments.subspan(kept)) {
    if (isSeen(pixel, fragment, sample)) tail.push_back(fragment);
  }
  return compose(result, weightedAverage(tail));
}

bool hasBody(const Fragment& fragment) {
  return fragment.blend == layout::VITRAIL_OVER || fragment.blend == layout::VITRAIL_PREMULTIPLIED;
}

} // namespace

Blended blendOf(const Fragment& stored) {
  const Color& c = stored.color;
  const double a = c[3];
  Blended pair;
  switch (stored.blend) {
    case layout::VITRAIL_OVER:
      pair.color = {a * c[0], a * c[1], a * c[2], a};
      pair.transmittance.fill(1.0 - a);
      break;
    case layout::VITRAIL_PREMULTIPLIED:
      pair.color = c;
      pair.transmittance.fill(1.0 - a);
      break;
    case layout::VITRAIL_ADDITIVE:
      pair.color = {a * c[0], a * c[1], a * c[2], 0.0};
      break;
    default: // VITRAIL_MULTIPLY
      pair.transmittance = {1.0 - a + a * c[0], 1.0 - a + a * c[1], 1.0 - a + a * c[2], 1.0};
      break;
  }
  return pair;
}

Blended compose(const Blended& front, const Blended& behind) {
  Blended pair;
  for (unsigned i = 0; i < 4; ++i) {
    pair.color[i] = front.color[i] + front.transmittance[i] * behind.color[i];
    pair.transmittance[i] = front.transmittance[i] * behind.transmittance[i];
  }
  return pair;
}

Color over(const Blended& front, const Color& behind) { return compose(front, {behind, {}}).color; }

Blended weightedAverage(std::span<const Fragment> stored) {
  Blended sum;
  double alphas = 0.0;
  for (const Fragment& fragment : stored) {
    const Blended pair = blendOf(fragment);
    for (unsigned i = 0; i < 4; ++i) {
      sum.color[i] += pair.color[i];
      sum.transmittance[i] *= pair.transmittance[i];
    }
    if (hasBody(fragment)) alphas += fragment.color[3];
  }
  const double opacity = 1.0 - sum.transmittance[3];
  for (unsigned i = 0; i < 3; ++i) sum.color[i] *= alphas > 0.0 ? opacity / alphas : 1.0;
  sum.color[3] = opacity;
  return sum;
}

Blended resolveSample(const PixelList& pixel, std::uint32_t sample) {
  return resolveSorted(pixel, sorted(pixel), sample);
}

Color resolvePixel(const PixelList& pixel, std::span<const Color> behind) {
  const std::vector<Fragment> fragments = sorted(pixel);
  Color mean{};
  for (std::uint32_t sample = 0; sample < pixel.coding.samples; ++sample) {
    const Color color = over(resolveSorted(pixel, fragments, sample), behind[sample]);
    for (unsigned i = 0; i < 4; ++i) mean[i] += color[i] / pixel.coding.samples;
  }
  return mean;
}

} // namespace vitrail
