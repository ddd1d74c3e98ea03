// The nearest fragments of each pixel, sorted in by one fragment at a time: the insertion of methods `loop`, with the
// critical sections of fragment shader interlock (VK_EXT_fragment_shader_interlock) in place of atomics, as Salvi,
// "Pixel Synchronization" (SIGGRAPH 2013 courses, Advances in Real-Time Rendering), uses them. The sections need no
// order, since the nearest are the same in any.
//
// Cost: one draw of the surfaces, whose fragments of one pixel wait for each other and read up to as many layers as
// there are (--layers, 8 by default); a pass that clears layers x 8 + 24 bytes a pixel, and one that reads the layers
// in use.
//
// What it gets wrong: fragments beyond the nearest layers, as `loop`.
#include <memory>

#include "../method.h"
#include "../methods.h"
#include "../shared/device_needs.h"
#include "../shared/nearest_layers.h"
#include "shaders/interlock.frag.h"

namespace vitrail::tool {

namespace {

class Interlock final : public NearestLayers {
 public:
  Interlock(const MethodHost& host, const MethodOptions& options);

 private:
  void drawSurfaces(Frame& frame) override;

  SurfacePipelines surfaces_;
};

Interlock::Interlock(const MethodHost& host, const MethodOptions& options)
    : NearestLayers((requireDevice(host.gpu, "interlock"), host), options),
      surfaces_(makeSurfaces(host, shaders::interlock_frag, "interlock")) {}

void Interlock::drawSurfaces(Frame& frame) {
  drawOnce(frame, surfaces_);
  frame.endPass("collect");
}

} // namespace

std::unique_ptr<Method> makeInterlock(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<Interlock>(host, options);
}

} // namespace vitrail::tool
