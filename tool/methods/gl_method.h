// A transparency method as a driver that draws with OpenGL (render/gl_still.h) sees it. What Method is with Vulkan.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "../opengl/gl_frame.h"
#include "frame_stats.h"
#include "method_options.h"

namespace vitrail::tool {

// What a method is made for.
struct GlMethodHost {
  Gl& gl;                     // outlives the method
  const GlSurfaces& surfaces; // so do these
  const Scene& scene;         // what they show; there while the method is made, its geometry only if it sortsOnHost
};

// The picture that frames are drawn into.
struct GlMethodTarget {
  const GlImages* images = nullptr;
  // Bytes that the method may keep for fragments. Default: what the device can give. For methods that have it.
  std::optional<std::uint64_t> memoryBudget;
  bool surfaces = true;                            // whether there is anything transparent
  std::function<void(std::uint32_t tiles)> onTile; // where not empty, told how many tiles of a picture are done
};

class GlMethod {
 public:
  GlMethod() = default;
  virtual ~GlMethod() = default;
  GlMethod(const GlMethod&) = delete;
  GlMethod& operator=(const GlMethod&) = delete;

  // What the method asks of the images.
  virtual GlImageNeeds needs() const { return {}; }

  // Makes what frames of this target need; keeps what it has where that fits. Throws GpuError.
  virtual void setTarget(const GlMethodTarget& /*target*/) {}
  // Lets go of the target, before its images are destroyed.
  virtual void releaseTarget() {}

  // Draws the transparent surfaces of a picture, whose opaque scene has been drawn, as Method::draw() does. The depth
  // test is on, nearer or equal, and writes nothing. Leaves blending, scissor and stencil test off. Throws GpuError.
  virtual void draw(GlFrame& frame) = 0;

  // Takes note of what the device reported, once it has drawn all of the picture. False: the picture must be drawn
  // again, the opaque scene too, for which the method has made room. Throws GpuError where the device cannot hold it.
  virtual bool finish() { return true; }

  // What was reported of the picture, and what was taken of the method's choices.
  virtual FrameStats stats() const = 0;
};

} // namespace vitrail::tool
