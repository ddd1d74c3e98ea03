// The nearest fragments of each pixel by atomic minima: Liu, Huang, Liu and Wu, "FreePipe: a Programmable Parallel
// Rendering Architecture for Efficient Multi-Fragment Effects" (I3D 2010), in which depths sort themselves in by a loop
// of atomicMin; the tail after Maule, Comba, Torchelsen and Bastos, "Hybrid Transparency" (I3D 2013). A layer keeps the
// least of what comes by and sends the others on, so the layers end in order whatever comes first.
//
// `loop` draws the surfaces twice: first 32-bit depths, then the colours where their depths have come to lie. `loop-64`
// draws them once: depth and colour are one 64-bit integer, where the device has atomic minima of those.
//
// Cost: one or two draws of the surfaces, with up to as many atomics a fragment as there are layers (--layers, 8 by
// default); a pass that clears layers x 8 + 24 bytes a pixel, and one that reads the layers that are in use.
//
// What it gets wrong: fragments beyond the nearest layers, which are blended as if at one depth, their filters without
// colour; such a frame is reported as not exact. `loop` stores an opaque white with red 254/255.
#pragma once

#include <optional>

#include "../shared/nearest_layers.h"

namespace vitrail::tool {

class Loop final : public NearestLayers {
 public:
  // Throws GpuError.
  Loop(const MethodHost& host, const MethodOptions& options);

  std::string_view name() const override { return colors_ ? "loop" : "loop-64"; }

 private:
  void drawSurfaces(Frame& frame) override;

  SurfacePipelines first_; // depths; in loop-64, all
  std::optional<SurfacePipelines> colors_;
};

} // namespace vitrail::tool
