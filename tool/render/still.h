// Draws pictures one by one, each exactly, whatever its memory budget: as many frames, or tiles of one, as that takes.
// A small forward renderer that plays the part of an engine which embeds Vitrail: the stage draws opaque and
// alpha-masked geometry, a transparency method the rest, and the picture is encoded as 8-bit sRGB. docs/shading.md
// states what it computes.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "../gpu/device.h"
#include "../image/picture.h"
#include "../methods/method_options.h"
#include "../scene/camera.h"
#include "../scene/scene.h"
#include "../stage/draw_order.h"
#include "frame_report.h"

namespace vitrail::tool {

struct RenderOptions {
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  View view;
  Background background;
  // Bytes that the method may keep for fragments, at least 64 KiB: a frame that needs more is drawn in tiles. The
  // picture is the same. Default: what the device can give.
  std::optional<std::uint64_t> memoryBudget;
  Encoding encoding = Encoding::Srgb8;
  std::function<void(std::uint32_t tiles)> onTile; // told how many tiles are done, for people who wait
};

struct RenderResult {
  Picture picture;      // of Encoding::Srgb8
  DeepPicture deep;     // of the others
  bool isEmpty = false; // no pixel differs from the background alone
  FrameReport report;
};

// Holds one scene on the GPU. The Gpu outlives it; the scene need not.
class StillRenderer {
 public:
  // With `opacity`, every material is blended with that factor (X-ray view). The method options have passed
  // checkMethodOptions(), or are kLayerCount's (methods/methods.h). Throws GpuError (gpu/device.h), also where the
  // device does not offer them.
  StillRenderer(Gpu& gpu, const Scene& scene, std::optional<float> opacity = {}, DrawOrder order = DrawOrder::Forward,
                const MethodOptions& method = {});
  // The same of a scene that nobody else needs: its geometry is let go of as it goes to the GPU, so that a large model
  // is in memory once, except with methods that sort it on the host.
  StillRenderer(Gpu& gpu, Scene&& scene, std::optional<float> opacity, const MethodOptions& method);
  ~StillRenderer();
  StillRenderer(const StillRenderer&) = delete;
  StillRenderer& operator=(const StillRenderer&) = delete;

  // Renders one picture and waits for it. Throws GpuError.
  RenderResult render(const RenderOptions& options);

  // The same without the encode pass and without a picture, for measurements: repeated calls draw one frame each, with
  // all that earlier calls of the same options made. Throws GpuError.
  FrameReport measure(const RenderOptions& options);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vitrail::tool
