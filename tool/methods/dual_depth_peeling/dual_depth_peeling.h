// Dual depth peeling: Bavoil and Myers, "Order Independent Transparency with Dual Depth Peeling" (NVIDIA 2008). Each
// pass takes the nearest and the farthest layer that is left, at depths that the pass before it found by MAX blending
// of (z, -z) in two channels. The nearer one is blended under the front, the farther one over the back. As many
// passes as the deepest pixel needs, which is measured (depth_complexity.h).
//
// Cost: 1 + n / 2 draws of the surfaces for n layers in the deepest pixel, each of which writes five attachments; what
// has textures is shaded in each, since neighbours take derivatives. Nine images of the picture's size, 96 bytes a
// pixel, however many layers there are. One sample a pixel.
//
// What it gets wrong: surfaces of one pixel at equal depths are one layer. Here their colours are added and their
// opacities united, instead of the MAX of the paper, which loses all but one; the sum is then scaled as if they were
// equal, which is exact where they are and evens them out where they are not. The order of submission does not show.
// Each layer is kept in 16-bit floats.
#pragma once

#include <array>

#include "../../gpu/pixel_pass.h"
#include "../method.h"
#include "../shared/depth_complexity.h"

namespace vitrail::tool {

class DualDepthPeeling final : public Method {
 public:
  // Throws GpuError.
  explicit DualDepthPeeling(const MethodHost& host);

  std::string_view name() const override { return "dual-depth-peeling"; }
  MethodNeeds needs() const override { return DepthComplexity::kNeeds; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  MethodStats stats() const override;

 private:
  void clear(Frame& frame);
  void peel(Frame& frame, std::uint32_t pass);
  void blend(Frame& frame, std::uint32_t step);

  Gpu& gpu_;
  DepthComplexity complexity_;
  std::array<SingleSet, 2> peelSets_; // of each of the depths below, as what the last pass found
  SingleSet blendSet_;
  SurfacePipelines surfaces_;
  PixelPass blend_;
  VkExtent2D extent_{};
  std::array<UsedImage, 2> found_;  // by the last pass and the present one, in turns
  std::array<UsedImage, 4> layers_; // the nearer one's colour and opacity, the farther one's
  UsedImage back_;                  // the picture and all farther layers
  std::array<UsedImage, 2> front_;  // colour and transmittance of all nearer layers
};

} // namespace vitrail::tool
