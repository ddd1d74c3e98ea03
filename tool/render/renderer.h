// What draws pictures of one scene, one by one: on a Vulkan device (still.h) or on the processor (cpu_still.h).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "../image/picture.h"
#include "../scene/camera.h"
#include "../scene/scene.h"
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
  // The nearest transparent surfaces of each pixel (with several samples, of each sample) that are left out. Of the
  // methods linked-list and cpu.
  std::uint32_t peel = 0;
  // Whether fragments are counted also where that takes time: of a frame that is only timed nobody asks.
  bool counts = true;
  // Whether passes of a method behind which others come are timed, which takes time; else they are a part of those.
  // Where that makes no difference there is none.
  bool timesSteps = true;
  std::function<void(std::uint32_t tiles)> onTile; // told how many tiles are done, for people who wait
};

struct RenderResult {
  Picture picture;      // of Encoding::Srgb8
  DeepPicture deep;     // of the others
  bool isEmpty = false; // no pixel differs from the background alone
  FrameReport report;
};

class Renderer {
 public:
  Renderer() = default;
  virtual ~Renderer() = default;
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Renders one picture and waits for it. Throws GpuError (gpu/device.h).
  virtual RenderResult render(const RenderOptions& options) = 0;

  // The same without the encode pass and without a picture, for measurements: repeated calls draw one frame each, with
  // all that earlier calls of the same options made. Throws GpuError.
  virtual FrameReport measure(const RenderOptions& options) = 0;
};

} // namespace vitrail::tool
