// The tool's host renderer: a small forward renderer that plays the part of an engine which embeds Vitrail.
// It draws opaque and alpha-masked geometry, lets a transparency method collect and resolve the rest, and encodes the
// picture as 8-bit sRGB. docs/shading.md states what it computes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../gpu/device.h"
#include "../image/picture.h"
#include "../methods/method_options.h"
#include "../scene/camera.h"
#include "../scene/scene.h"
#include "../stage/draw_order.h"

namespace vitrail::tool {

struct RenderOptions {
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  View view;
  Background background;
  // Bytes that the method may keep for fragments, at least 64 KiB: a frame that needs more is drawn in tiles. The
  // picture is the same. Default: what the device can give.
  std::optional<std::uint64_t> memoryBudget;
};

// What `--json` reports about a frame.
struct FrameReport {
  std::string device;
  std::string api;    // "Vulkan 1.3"
  std::string method; // "linked-list"
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 1;
  std::string nodes;       // "compact", "standard", "hdr"; empty where the method has no choice
  std::string resolve;     // "compute", "fragment"; empty where the method has none
  std::string linking;     // the same of who links lists
  std::string msaaResolve; // "per-pixel", "per-sample"; empty at one sample and where `resolve` is
  bool exact = false;
  bool counted = false; // whether the method counts fragments: else the counts and layers are 0
  std::uint64_t fragmentsRequested = 0;
  std::uint64_t fragmentsStored = 0;
  std::uint64_t fragmentsMissing = 0;
  std::uint32_t approximatePixels = 0;
  std::uint32_t layersMax = 0;
  double layersMean = 0.0; // over pixels that hold at least one fragment; 0 where there are none
  std::uint32_t tiles = 1; // areas that were collected and resolved one after the other
  std::uint64_t nodesBytes = 0;
  std::uint64_t headsBytes = 0;
  std::uint64_t totalBytes = 0; // all that the method keeps for the picture: nodes, heads, lists, counters
  std::uint64_t peakBytes = 0;  // the most device memory that the tool and the library held at once
  // GPU time, in order: opaque, the passes that the method names, encode. With fragment lists those are clear, collect,
  // link where linking is a pass of its own, and resolve; unsorted has blend; a multisampled picture has box_filter
  // before encode. Summed over tiles. What the host works on a frame before the GPU can go on stands among them, as
  // sort. Empty, and frameMs 0, on devices without timestamps.
  std::vector<std::pair<std::string, double>> passesMs;
  double frameMs = 0.0;                   // of all passes
  std::vector<std::uint32_t> pixelLayers; // of the method layer-count alone: the fragments of each pixel
};

struct RenderResult {
  Picture picture;
  FrameReport report;
};

// Holds one scene on the GPU. The Gpu outlives it; the scene need not.
class Renderer {
 public:
  // With `opacity`, every material is blended with that factor (X-ray view). The method options have passed
  // checkMethodOptions(), or are kLayerCount's (methods/layer_count.h). Throws GpuError (device.h), also where the
  // device does not offer them.
  Renderer(Gpu& gpu, const Scene& scene, std::optional<float> opacity = {}, DrawOrder order = DrawOrder::Forward,
           const MethodOptions& method = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

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
