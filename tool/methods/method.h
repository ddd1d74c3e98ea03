// A transparency method, as the host renderer sees it. The renderer draws the opaque scene, then between cmdClear() and
// cmdCollected() all transparent surfaces with the method's fragment shader, and the method blends them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <volk.h>

namespace vitrail::tool {

// What a method blends into: linear colour with premultiplied alpha, R16G16B16A16_SFLOAT, with storage usage.
struct MethodTarget {
  VkExtent2D extent{};
  VkImageView color = VK_NULL_HANDLE;
  // Fixes the number of fragments that are kept. Default: as many as the frame has.
  std::optional<std::uint32_t> nodeCapacity;
};

struct MethodStats {
  bool exact = false;
  std::uint64_t fragmentsRequested = 0;
  std::uint64_t fragmentsStored = 0;
  std::uint64_t fragmentsMissing = 0;
  std::uint32_t cutPixels = 0; // pixels that the driver did not let the method finish
  std::uint32_t layersMax = 0;
  double layersMean = 0.0; // over covered pixels
  std::uint64_t nodesBytes = 0;
  std::uint64_t headsBytes = 0;
};

class Method {
 public:
  Method() = default;
  virtual ~Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  virtual std::string_view name() const = 0; // in reports

  // The fragment shader that every transparent surface is drawn with (SPIR-V), and the layout of its descriptor set 2.
  // Sets 0 and 1 are the renderer's, shaders/surface.glsl.
  virtual std::span<const std::uint32_t> collectShader() const = 0;
  virtual VkDescriptorSetLayout collectLayout() const = 0;
  virtual VkDescriptorSet collectSet() const = 0; // of the present target

  // Makes what frames of this target need; keeps what it has where that fits. No frame is pending. Throws GpuError.
  virtual void setTarget(const MethodTarget& target) = 0;
  // Lets go of the target, before its colour view is destroyed.
  virtual void releaseTarget() = 0;

  // Recorded outside rendering scopes, in this order in every frame. cmdResolve() reads and writes the colour image by
  // compute, in VK_IMAGE_LAYOUT_GENERAL.
  virtual void cmdClear(VkCommandBuffer commands, std::uint64_t frame) = 0;
  virtual void cmdCollected(VkCommandBuffer commands) = 0;
  virtual void cmdResolve(VkCommandBuffer commands) = 0;

  // What the GPU reported of a frame that has finished.
  virtual MethodStats stats(std::uint64_t frame) const = 0;

  // Makes room for the fragments that a frame missed. False where the target has all it may have: the frame
  // stays as it is. Throws GpuError where the device cannot hold so many.
  virtual bool grow(const MethodStats& stats) = 0;
};

} // namespace vitrail::tool
