// A transparency method, as a driver (render/) sees it. The stage draws the opaque scene; the method draws the
// transparent surfaces over it, in as many passes as it takes, with what a Frame gives it (stage/frame.h).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include <volk.h>

#include "../gpu/device.h"
#include "../stage/frame.h"
#include "../stage/surfaces.h"
#include "frame_stats.h"
#include "method_options.h"

namespace vitrail::tool {

// What a method is made for.
struct MethodHost {
  Gpu& gpu;                 // outlives the method
  const Surfaces& surfaces; // so do these
  const Scene& scene;       // what they show; there while the method is made, its geometry only if it sortsOnHost
};

// The images of a picture, for descriptors. The stage holds them, R16G16B16A16_SFLOAT with premultiplied linear colour;
// Frame::images() has them too.
struct MethodTarget {
  VkExtent2D extent{};
  VkImageView color = VK_NULL_HANDLE;   // single-sample, with storage usage
  VkImageView opaque = VK_NULL_HANDLE;  // samples > 1: the multisampled colour, with sampled usage unless perSample
  VkImageView depth = VK_NULL_HANDLE;   // the opaque depth, where ImageNeeds::depthUsage has it sampled
  VkImageView stencil = VK_NULL_HANDLE; // and the stencil beside it, where ImageNeeds::stencil has one
  // Bytes that the method may keep for fragments. Default: what the device can give. For methods that have it.
  std::optional<std::uint64_t> memoryBudget;
  bool surfaces = true;   // whether there is anything transparent
  std::uint32_t peel = 0; // the nearest surfaces of each pixel that are left out, where the method does that
  std::function<void(std::uint32_t tiles)> onTile; // where not empty, told how many tiles of a picture are done
  // More than 1: pictures are drawn without waiting for any (Method::drawsInFlight), and so many may be pending at
  // once. What a method has to replace meanwhile it replaces behind waitForFrames().
  std::uint32_t framesInFlight = 1;
  std::function<void()> waitForFrames;
};

class Method {
 public:
  Method() = default;
  virtual ~Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  // What the method asks of the stage's images. Several samples: with perSample it leaves a multisampled picture, else
  // it writes the single-sample one from the multisampled opaque images. With a stencil: 0 after the opaque scene.
  virtual ImageNeeds needs() const { return {}; }

  // Makes what frames of this target need; keeps what it has where that fits. No frame is pending. Throws GpuError.
  virtual void setTarget(const MethodTarget& /*target*/) {}
  // Lets go of the target, before its views are destroyed.
  virtual void releaseTarget() {}

  // Draws the transparent surfaces of a picture, whose opaque scene has been drawn: the depth of frame.images() holds
  // the nearest opaque surfaces, which hide what is behind them; the colour holds theirs. Leaves the picture in
  // images().color(), or, where ImageNeeds::perSample says so, in images().drawn(). Every pass ends with
  // frame.endPass() under a name of the method's choice. A method that has to read something back before it can go on
  // calls frame.submitAndWait(). Throws GpuError.
  virtual void draw(Frame& frame) = 0;

  // Takes note of what the GPU reported, once it has executed all of the picture. False: the picture must be drawn
  // again, the opaque scene too, for which the method has made room. Throws GpuError where the device cannot hold it.
  virtual bool finish() { return true; }

  // What was reported of the picture, and what was taken of the method's choices.
  virtual FrameStats stats() const = 0;

  // Whether the target's pictures are drawn in flight: draw() draws each once, into the memory that there is, which
  // follows what pictures need, and neither waits nor submits; finish() and stats() are left out. A picture of another
  // target, or for which the device has no room so, is drawn by the calls above.
  virtual bool drawsInFlight() const { return false; }
  // The number of the picture that draw() drew last, and what was reported of one that the GPU has executed, before the
  // one `framesInFlight` behind it is drawn.
  virtual std::uint64_t lastPicture() const { return 0; }
  virtual FrameStats statsOf(std::uint64_t /*picture*/) { return stats(); }
};

} // namespace vitrail::tool
