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
#include <memory>
#include <optional>

#include "../../gpu/accesses.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/device_needs.h"
#include "../shared/nearest_layers.h"
#include "shaders/loop_64.frag.h"
#include "shaders/loop_colors.frag.h"
#include "shaders/loop_depths.frag.h"

namespace vitrail::tool {

namespace {

bool isWide(const MethodHost& host, const MethodOptions& options) {
  if (options.name != "loop-64") return false;
  requireDevice(host.gpu, "loop-64");
  return true;
}

class Loop final : public NearestLayers {
 public:
  Loop(const MethodHost& host, const MethodOptions& options);

 private:
  void drawSurfaces(Frame& frame) override;

  SurfacePipelines first_; // depths; in loop-64, all
  std::optional<SurfacePipelines> colors_;
};

Loop::Loop(const MethodHost& host, const MethodOptions& options)
    : NearestLayers(host, options),
      first_(isWide(host, options) ? makeSurfaces(host, shaders::loop_64_frag, "loop-64")
                                   : makeSurfaces(host, shaders::loop_depths_frag, "loop depths")) {
  if (options.name == "loop") colors_ = makeSurfaces(host, shaders::loop_colors_frag, "loop colours");
}

void Loop::drawSurfaces(Frame& frame) {
  drawOnce(frame, first_);
  frame.endPass(colors_ ? "depths" : "collect");
  if (!colors_) return;
  // The first draw wrote depths -> the second one reads them, and goes on writing entries.
  cmdMemoryBarrier(frame.commands(), kFragmentWrite, kFragmentReadWrite);
  drawOnce(frame, *colors_);
  frame.endPass("colours");
}

} // namespace

std::unique_ptr<Method> makeLoop(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<Loop>(host, options);
}

} // namespace vitrail::tool
