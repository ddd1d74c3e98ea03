// Moment-based order-independent transparency with four power moments: Muenstermann, Krumpen, Klein and Peters,
// "Moment-Based Order-Independent Transparency" (PACM CGIT 1(1), I3D 2018). A first draw of the surfaces adds up their
// absorbance, -ln of the transmittance, times the powers 0 to 4 of depth; a second one dims each fragment's light by
// the transmittance in front of it that those moments tell of, with the paper's bias (5e-7) and overestimation (0.25).
// The composite scales what was added to the opacity of all surfaces together, which is known, and puts it over the
// picture. Depth is on a logarithmic scale with perspective, fitted to the boxes around the surfaces.
//
// Cost: two draws of the surfaces, both shaded in full, whose fragments blend into 20 bytes (R32G32B32A32_SFLOAT and
// R32_SFLOAT; with filters 28) and into 8, and one pass over the picture: 28 bytes a pixel, 36 with filters. One sample
// a pixel: the second draw reads the moments of a pixel.
//
// What it gets wrong: four moments tell where two surfaces lie, and roughly where more do: light leaks through opaque
// surfaces that lie among many others, and colours of dense stacks are smeared over their depths. The overestimation
// alone puts two panes off by a few 255ths. A surface that lets nothing through counts as one that lets 1/4096 through.
// Surfaces behind tinted glass are dimmed and not tinted; what is behind all surfaces is tinted exactly. One surface in
// a pixel is exact. The order of submission changes the rounding of sums and nothing else.
#pragma once

#include "../shared/composite.h"
#include "../shared/planes.h"

namespace vitrail::tool {

class Moment final : public Method {
 public:
  // Throws GpuError.
  explicit Moment(const MethodHost& host);

  std::string_view name() const override { return "moment"; }
  MethodNeeds needs() const override { return {}; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override { planes_.releaseTarget(); }
  void draw(Frame& frame) override;
  MethodStats stats() const override { return {.counted = false, .totalBytes = planes_.bytes()}; }

 private:
  Gpu& gpu_;
  bool filters_;
  Planes planes_;
  SingleSet moments_; // what the second draw reads
  SurfacePipelines absorbance_;
  SurfacePipelines light_;
  Composite composite_;
};

} // namespace vitrail::tool
