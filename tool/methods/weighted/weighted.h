// Weighted blended order-independent transparency: McGuire and Bavoil, "Weighted Blended Order-Independent
// Transparency" (JCGT 2(2), 2013). Every fragment adds its premultiplied colour and its opacity, both times a weight
// that falls with depth, and multiplies what is let through; the composite puts the weighted mean colour over the
// picture by the exact product of the transmittances. The weight is the paper's equation 10, max(1e-2, 3e3 (1 -
// d(z))^3), in which d(z) is the depth in a window whose near and far planes fit the boxes around the surfaces. Light
// of additive surfaces, and what tinted glass reflects without hiding anything, is added beside the mean; the filters
// of tinted glass multiply, in each channel.
//
// Cost: one draw of the surfaces, whose every fragment blends into two planes (R16G16B16A16_SFLOAT and R16_SFLOAT, 10
// bytes a sample; with filters three of 8 bytes), and one pass over the picture.
//
// What it gets wrong: only the order in which surfaces lie decides their colours' shares through the weight, so near
// surfaces that hide others let too much of them through, and colours wash out towards the mean: the more so the more
// opaque surfaces are and the closer they lie. Light that is added is not dimmed by what is in front of it. One surface
// in a pixel is exact; what is behind all surfaces is dimmed exactly, up to the planes' rounding. The order of
// submission changes the rounding of sums and nothing else.
#pragma once

#include "../shared/composite.h"
#include "../shared/planes.h"

namespace vitrail::tool {

class Weighted final : public Method {
 public:
  // Throws GpuError.
  Weighted(const MethodHost& host, const MethodOptions& options);

  std::string_view name() const override { return "weighted"; }
  MethodNeeds needs() const override { return {}; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override { planes_.releaseTarget(); }
  void draw(Frame& frame) override;
  MethodStats stats() const override { return {.counted = false, .totalBytes = planes_.bytes()}; }

 private:
  Gpu& gpu_;
  bool filters_;
  Planes planes_;
  SurfacePipelines surfaces_;
  Composite composite_;
};

} // namespace vitrail::tool
