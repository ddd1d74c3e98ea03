// Draws pictures one by one with OpenGL. What StillRenderer is with Vulkan, with the same shading.
#pragma once

#include <memory>
#include <optional>

#include "../methods/method_options.h"
#include "../opengl/gl.h"
#include "../stage/draw_order.h"
#include "renderer.h"

namespace vitrail::tool {

// Holds one scene. The Gl outlives it; the scene need not.
class GlStillRenderer final : public Renderer {
 public:
  // As StillRenderer's. Throws GpuError.
  GlStillRenderer(Gl& gl, const Scene& scene, std::optional<float> opacity, DrawOrder order,
                  const MethodOptions& method);
  GlStillRenderer(Gl& gl, Scene&& scene, std::optional<float> opacity, const MethodOptions& method);
  ~GlStillRenderer() override;

  RenderResult render(const RenderOptions& options) override;
  FrameReport measure(const RenderOptions& options) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vitrail::tool
