// Stochastic transparency: Enderton, Sintorn, Shirley and Luebke, "Stochastic Transparency" (I3D 2010), in its
// depth-based form. In each pass surfaces first write depth, opaque, in a random part of their samples that is as large
// as their opacity; then all that no sample's depth hides add their light, as large as their opacity says. A surface so
// is seen as often as surfaces before it let light through, and the mean over samples and passes tends to the exact
// picture. What all surfaces together let through of the opaque scene is not left to chance: a first draw multiplies
// it. The samples of a pixel are stratified, as in the paper. Randomness is a hash of pixel, pass and fragment: a frame
// is the same each time. --samples gives samples for this and for edges alike, --passes the passes.
//
// Cost: 1 + 2 draws of the surfaces a pass, 16 passes by default, and a copy of the depth each; one pass over the
// picture. Where some surfaces tint what is behind them each channel has passes of its own, three times as many. 22
// bytes a sample (28 with filters), whatever the depth complexity.
//
// What it gets wrong: noise, whose deviation is in proportion to 1 / sqrt(passes x samples), and coloured in pictures
// with tinted glass. The mean is the exact picture, except among surfaces at the very same depth, which do not hide
// each other; and with several samples surfaces that cross are ordered in each sample, where lists order them once a
// pixel. One surface in a pixel is exact. The order of submission changes the rounding of sums and nothing else.
#pragma once

#include "../shared/composite.h"
#include "../shared/planes.h"

namespace vitrail::tool {

class Stochastic final : public Method {
 public:
  // Throws GpuError.
  Stochastic(const MethodHost& host, const MethodOptions& options);

  std::string_view name() const override { return "stochastic"; }
  MethodNeeds needs() const override { return {.depthUsage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT}; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  MethodStats stats() const override;

 private:
  void drawTotal(Frame& frame);
  void cmdCopyDepth(Frame& frame);
  void drawPass(Frame& frame, std::uint32_t number, std::uint32_t channel);

  Gpu& gpu_;
  std::uint32_t samples_;
  std::uint32_t passes_;
  bool filters_;
  bool tints_; // some surface lets channels through differently
  Planes planes_;
  SurfacePipelines total_;
  SurfacePipelines cover_;
  SurfacePipelines light_;
  Composite composite_;
  UsedImage depth_; // of a pass
};

} // namespace vitrail::tool
