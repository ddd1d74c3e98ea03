#include "interlock.h"

#include <fmt/format.h>

#include "shaders/interlock.frag.h"

namespace vitrail::tool {

void requireInterlock(const Gpu& gpu, const std::string& method) {
  if (gpu.features().fragmentInterlock) return;
  throw GpuError(fmt::format("{} has no fragment shader interlock, which the method {} needs: use loop",
                             gpu.properties().deviceName, method));
}

Interlock::Interlock(const MethodHost& host, const MethodOptions& options)
    : NearestLayers((requireInterlock(host.gpu, "interlock"), host), options),
      surfaces_(makeSurfaces(host, shaders::interlock_frag, "interlock")) {}

void Interlock::drawSurfaces(Frame& frame) {
  drawOnce(frame, surfaces_);
  frame.endPass("collect");
}

} // namespace vitrail::tool
