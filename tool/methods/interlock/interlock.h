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
#pragma once

#include "../shared/nearest_layers.h"

namespace vitrail::tool {

// Throws GpuError where the device has no fragment shader interlock; `method` is who needs it.
void requireInterlock(const Gpu& gpu, const std::string& method);

class Interlock final : public NearestLayers {
 public:
  // Throws GpuError.
  Interlock(const MethodHost& host, const MethodOptions& options);

  std::string_view name() const override { return "interlock"; }

 private:
  void drawSurfaces(Frame& frame) override;

  SurfacePipelines surfaces_;
};

} // namespace vitrail::tool
