// A transparency method, as the host renderer sees it. The renderer draws the opaque scene; the method draws the
// transparent surfaces over it, in as many passes as it takes, with what a Frame gives it (stage/frame.h).
//
// A method is a file of its own: a class whose constructor makes its pipelines, an entry in makeMethod() (method.cpp)
// and one in the table of method_options.cpp, which says what options it has; others are refused.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include <volk.h>

#include "../gpu/device.h"
#include "../stage/frame.h"
#include "../stage/surfaces.h"
#include "method_options.h"

namespace vitrail::tool {

// What a method asks of the renderer's images.
struct MethodNeeds {
  // Several samples: whether the method leaves a multisampled picture, which the renderer box-filters, or writes the
  // single-sample one from the multisampled opaque images, whose colour then is sampled.
  bool perSample = false;
  bool stencil = false;             // beside the opaque depth: 0 after the opaque scene
  VkImageUsageFlags depthUsage = 0; // of the opaque depth beside the depth test: sampled, copied
};

// What a method is made for.
struct MethodHost {
  Gpu& gpu;                 // outlives the method
  const Surfaces& surfaces; // so do these
  const Scene& scene;       // what they show; there while the method is made
};

// The images of a picture, for descriptors. The renderer holds them, R16G16B16A16_SFLOAT with premultiplied linear
// colour; Frame::images() has them too.
struct MethodTarget {
  VkExtent2D extent{};
  VkImageView color = VK_NULL_HANDLE;   // single-sample, with storage usage
  VkImageView opaque = VK_NULL_HANDLE;  // samples > 1: the multisampled colour, with sampled usage unless perSample
  VkImageView depth = VK_NULL_HANDLE;   // the opaque depth, where MethodNeeds::depthUsage has it sampled
  VkImageView stencil = VK_NULL_HANDLE; // and the stencil beside it, where MethodNeeds::stencil has one
  // Bytes that the method may keep for fragments. Default: what the device can give. For methods that have it.
  std::optional<std::uint64_t> memoryBudget;
  bool surfaces = true; // whether there is anything transparent
};

struct MethodStats {
  bool counted = true; // whether the method counts fragments; else the counts below are 0
  bool exact = false;
  std::uint64_t fragmentsRequested = 0;
  std::uint64_t fragmentsStored = 0;
  std::uint64_t fragmentsMissing = 0;
  std::uint32_t approximatePixels = 0;
  std::uint32_t cutPixels = 0; // pixels that the driver did not let the method finish
  std::uint32_t layersMax = 0;
  double layersMean = 0.0; // over covered pixels
  std::uint32_t tiles = 1; // areas that were resolved
  std::uint64_t nodesBytes = 0;
  std::uint64_t headsBytes = 0;
  std::uint64_t totalBytes = 0;             // all that the method keeps on the device for its target
  std::vector<std::uint32_t> pixelLayers{}; // of layer-count: the fragments of each pixel, rows top to bottom
};

// MethodStats::layersMean of so many pixels that have fragments.
inline double meanLayers(std::uint64_t fragments, std::uint64_t coveredPixels) {
  return coveredPixels > 0 ? static_cast<double>(fragments) / static_cast<double>(coveredPixels) : 0.0;
}

class Method {
 public:
  Method() = default;
  virtual ~Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  // In reports: the name, the node format, the resolve and the linking ("compute", "fragment"), where the method has
  // such.
  virtual std::string_view name() const = 0;
  virtual std::string_view nodes() const { return {}; }
  virtual std::string_view resolve() const { return {}; }
  virtual std::string_view linking() const { return {}; }
  virtual MethodNeeds needs() const = 0;

  // Makes what frames of this target need; keeps what it has where that fits. No frame is pending. Throws GpuError.
  virtual void setTarget(const MethodTarget& /*target*/) {}
  // Lets go of the target, before its views are destroyed.
  virtual void releaseTarget() {}

  // Draws the transparent surfaces of a picture, whose opaque scene has been drawn: the depth of frame.images() holds
  // the nearest opaque surfaces, which hide what is behind them; the colour holds theirs. Leaves the picture in
  // images().color(), or, where MethodNeeds::perSample says so, in images().drawn(). Every pass ends with
  // frame.endPass() under a name of the method's choice. A method that has to read something back before it can go on
  // calls frame.submitAndWait(). Throws GpuError.
  virtual void draw(Frame& frame) = 0;

  // Takes note of what the GPU reported, once it has executed all of the picture. False: the picture must be drawn
  // again, the opaque scene too, for which the method has made room. Throws GpuError where the device cannot hold it.
  virtual bool finish() { return true; }

  // What was reported of the picture.
  virtual MethodStats stats() const = 0;
};

// Makes a method. The options have passed checkMethodOptions(), or are kLayerCount's (layer_count.h). Throws GpuError
// where the device does not offer them.
std::unique_ptr<Method> makeMethod(const MethodHost& host, const MethodOptions& options);

} // namespace vitrail::tool
