#include "peel.h"

namespace vitrail::tool {

namespace {

// What is in front of the light behind a pixel: its own light, what it lets through of each colour, and of alpha.
struct Front {
  float light[3] = {0.0F, 0.0F, 0.0F};
  float filter[3] = {1.0F, 1.0F, 1.0F};
  float through = 1.0F;

  void add(const VitrailLayer& layer) {
    const float alpha = layer.color[3];
    switch (layer.blend) {
      case VITRAIL_BLEND_MULTIPLY:
        for (int c = 0; c < 3; ++c) filter[c] *= layer.color[c];
        return;
      case VITRAIL_BLEND_ADDITIVE:
        for (int c = 0; c < 3; ++c) light[c] += filter[c] * layer.color[c];
        return;
      default:
        for (int c = 0; c < 3; ++c) {
          light[c] += filter[c] * layer.color[c] * (layer.blend == VITRAIL_BLEND_PREMULTIPLIED ? 1.0F : alpha);
          filter[c] *= 1.0F - alpha;
        }
        through *= 1.0F - alpha;
    }
  }

  void over(float* color) const {
    for (int c = 0; c < 3; ++c) color[c] = light[c] + filter[c] * color[c];
    color[3] = 1.0F - through + through * color[3];
  }
};

} // namespace

bool isFilterOf(const VitrailLayer& layer, const VitrailLayer& before) {
  return layer.blend == VITRAIL_BLEND_MULTIPLY && before.blend == VITRAIL_BLEND_PREMULTIPLIED &&
         layer.depth == before.depth && layer.word == before.word && layer.coverage == before.coverage;
}

void blendPeeled(std::span<const VitrailLayer> layers, std::uint32_t peeled, std::uint32_t samples, float* color) {
  for (std::uint32_t sample = 0; sample < samples; ++sample) {
    Front front;
    std::uint32_t met = 0; // fragments
    for (std::size_t i = 0; i < layers.size(); ++i) {
      if ((layers[i].coverage >> sample & 1U) == 0) continue;
      if (i == 0 || !isFilterOf(layers[i], layers[i - 1])) ++met;
      if (met > peeled) front.add(layers[i]);
    }
    front.over(color + std::size_t{4} * sample);
  }
}

} // namespace vitrail::tool
