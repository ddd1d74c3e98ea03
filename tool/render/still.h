// Draws pictures one by one, each exactly, whatever its memory budget: as many frames, or tiles of one, as that takes.
// A small forward renderer that plays the part of an engine which embeds Vitrail: the stage draws opaque and
// alpha-masked geometry, a transparency method the rest, and the picture is encoded as 8-bit sRGB. docs/shading.md
// states what it computes.
#pragma once

#include <memory>
#include <optional>

#include "../gpu/device.h"
#include "../methods/method_options.h"
#include "../stage/draw_order.h"
#include "renderer.h"

namespace vitrail::tool {

// Holds one scene on the GPU. The Gpu outlives it; the scene need not.
class StillRenderer final : public Renderer {
 public:
  // With `opacity`, every material is blended with that factor (X-ray view). The method options have passed
  // checkMethodOptions(), or are kLayerCount's (methods/methods.h). Throws GpuError (gpu/device.h), also where the
  // device does not offer them.
  StillRenderer(Gpu& gpu, const Scene& scene, std::optional<float> opacity = {}, DrawOrder order = DrawOrder::Forward,
                const MethodOptions& method = {});
  // The same of a scene that nobody else needs: its geometry is let go of as it goes to the GPU, so that a large model
  // is in memory once, except with methods that sort it on the host.
  StillRenderer(Gpu& gpu, Scene&& scene, std::optional<float> opacity, const MethodOptions& method);
  ~StillRenderer() override;

  RenderResult render(const RenderOptions& options) override;
  FrameReport measure(const RenderOptions& options) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vitrail::tool
