// Draws pictures one by one, each exactly, whatever its memory budget: as many frames, or tiles of one, as that takes.
// A small forward renderer that plays the part of an engine which embeds Vitrail: the stage draws opaque and
// alpha-masked geometry, a transparency method the rest, and the picture is encoded as 8-bit sRGB. docs/shading.md
// states what it computes.
#pragma once

#include <memory>
#include <optional>

#include "../gpu/device.h"
#include "../methods/method.h"
#include "../methods/method_options.h"
#include "../stage/draw_order.h"
#include "../stage/stage.h"
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

  // For a driver that draws other pictures of the scene in between (interactive.h): the same device's Stage, which
  // allows so many frames in flight, and the Method. None of its frames is pending when this class draws.
  StillRenderer(Gpu& gpu, const Scene& scene, std::optional<float> opacity, const MethodOptions& method,
                std::uint32_t framesInFlight);
  Stage& stage();
  Method& method();
  // Draws on images of that size from now on, where they had another. No frame is pending.
  void setSize(VkExtent2D size);
  // What the method is given of a picture on the stage's images.
  MethodTarget targetOf(const RenderOptions& picture);
  // What its report warns of.
  std::vector<std::string> warningsOf(const RenderOptions& picture, const FrameStats& stats) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vitrail::tool
