// Surfaces that are blended into the picture by OpenGL's fixed function, as they are drawn. What fixed_blending.h is
// with Vulkan.
#pragma once

#include <span>

#include "../gl_method.h"

namespace vitrail::tool {

class GlBlendedSurfaces {
 public:
  // Throws GpuError. `method` is who needs them.
  GlBlendedSurfaces(const GlMethodHost& host, const char* method);

  // Draws runs of the transparent surfaces, in their order, into the framebuffer of the opaque ones.
  void draw(GlFrame& frame, std::span<const SurfaceRun> runs) const;

 private:
  GlSurfacePrograms programs_;
};

} // namespace vitrail::tool
