// A transparency method, as the host renderer sees it. The renderer draws the opaque scene, then between cmdBegin() and
// cmdCollected() all transparent surfaces the way the method wants them drawn, and the method blends them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <vitrail/vitrail.h>
#include <volk.h>

#include "../draw/device.h"
#include "method_options.h"

namespace vitrail::tool {

// Where a method turns what was collected into colour.
enum class Blending {
  AsDrawn, // nowhere: surfaces blend into the colour image as they are drawn
  Compute, // compute shaders write the picture's colour image
  InScope, // a draw inside the renderer's rendering scope
};

// What a method asks of the renderer for every frame.
struct MethodNeeds {
  Blending blending = Blending::Compute;
  // Several samples: whether the method leaves a multisampled picture, which the renderer box-filters, or writes the
  // single-sample one from the multisampled opaque images.
  bool perSample = false;
  // Surfaces are drawn with a stencil, 0 after the opaque scene; an InScope resolve of a multisampled picture, or of
  // one sample, has it too.
  bool stencil = false;
  bool sampledDepth = false; // the resolve samples the multisampled depth
};

// How a method draws the transparent surfaces of one kind.
struct SurfaceDrawing {
  std::span<const std::uint32_t> fragmentShader; // SPIR-V. Sets 0 and 1 are the renderer's, shaders/surface.glsl
  // Specialization constants, id and value. Constant 0 is the renderer's.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> constants;
  // The blending into colour; required where Blending is AsDrawn, and unused elsewhere: there is no colour attachment.
  VkPipelineColorBlendAttachmentState blend{};
  VkStencilOpState stencil{}; // where MethodNeeds::stencil is set
};

// The images of a picture. The renderer holds them, R16G16B16A16_SFLOAT with premultiplied linear colour. With several
// samples a method reads the multisampled ones and writes the single-sample one, unless it is perSample.
struct MethodTarget {
  VkExtent2D extent{};
  VkImageView color = VK_NULL_HANDLE;  // single-sample, with storage usage
  VkImageView opaque = VK_NULL_HANDLE; // samples > 1: the multisampled colour, with sampled usage unless perSample
  VkImageView depth = VK_NULL_HANDLE;  // MethodNeeds::sampledDepth: the multisampled depth
  // Fixes the number of fragments that are kept; a frame that has more is blended approximately. Default: the frame's.
  std::optional<std::uint32_t> nodeCapacity;
  // Bytes that the method may keep for fragments. Default: what the device can give.
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
  std::uint64_t totalBytes = 0;           // all that the method keeps on the device for its target
  std::vector<std::uint32_t> pixelLayers; // of layer-count: the fragments of each pixel, rows top to bottom
};

class Method {
 public:
  Method() = default;
  virtual ~Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  virtual std::string_view name() const = 0;            // in reports
  virtual std::string_view nodes() const { return {}; } // the node format, where there is a choice
  virtual MethodNeeds needs() const = 0;

  // How surfaces with these features (shaders/shared.h) are drawn, and the layout of descriptor set 2 with the set that
  // the present target binds there. Null: the shaders have no set 2.
  virtual SurfaceDrawing surface(std::uint32_t features) const = 0;
  virtual VkDescriptorSetLayout surfaceLayout() const { return VK_NULL_HANDLE; }
  virtual VkDescriptorSet surfaceSet() const { return VK_NULL_HANDLE; }

  // Makes what frames of this target need; keeps what it has where that fits. No frame is pending. Throws GpuError.
  virtual void setTarget(const MethodTarget& target) = 0;
  // Lets go of the target, before its views are destroyed.
  virtual void releaseTarget() = 0;

  // Starts a picture. `bounds` are boxes around the transparent surfaces, valid during the call. The picture is drawn
  // in one area, all of it, or, where inTiles() says so afterwards, in those that nextTile() gives. Throws GpuError.
  virtual void startPicture(std::span<const VitrailBounds> /*bounds*/) {}
  virtual bool inTiles() const { return false; }
  virtual std::optional<VkRect2D> nextTile() { return std::nullopt; }

  // Recorded in this order for every area, with a number that rises by one. cmdResolve() is inside the renderer's scope
  // where Blending is InScope, and not called where it is AsDrawn; the others are outside of scopes. A resolve by
  // compute reads and writes the colour image in VK_IMAGE_LAYOUT_GENERAL; the multisampled images are in
  // VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL (opaque) and VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL (depth).
  virtual void cmdBegin(VkCommandBuffer /*commands*/, std::uint64_t /*frame*/, const VkRect2D& /*area*/) {}
  virtual void cmdCollected(VkCommandBuffer /*commands*/) {}
  virtual void cmdResolve(VkCommandBuffer /*commands*/) {}
  virtual void cmdEnd(VkCommandBuffer /*commands*/) {}

  // Takes note of what the GPU reported of an area that has finished. False: the picture must be drawn again from the
  // start, the opaque scene too, for which the method has made room. Throws GpuError where the device cannot hold it.
  virtual bool finishArea(std::uint64_t /*frame*/) { return true; }

  // What was reported of the picture, once all its areas have finished.
  virtual MethodStats stats() const = 0;
};

// Makes a method. The options have passed checkMethodOptions(). Throws GpuError where the device does not offer them.
std::unique_ptr<Method> makeMethod(Gpu& gpu, const MethodOptions& options);

} // namespace vitrail::tool
