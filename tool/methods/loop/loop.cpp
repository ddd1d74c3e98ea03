#include "loop.h"

#include <fmt/format.h>

#include "../../gpu/accesses.h"
#include "shaders/loop_64.frag.h"
#include "shaders/loop_colors.frag.h"
#include "shaders/loop_depths.frag.h"

namespace vitrail::tool {

namespace {

bool isWide(const MethodHost& host, const MethodOptions& options) {
  if (options.name != "loop-64") return false;
  if (host.gpu.features().int64Atomics) return true;
  throw GpuError(fmt::format("{} has no 64-bit atomics in buffers, which the method loop-64 needs: use loop",
                             host.gpu.properties().deviceName));
}

} // namespace

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

} // namespace vitrail::tool
