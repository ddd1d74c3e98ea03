// What methods share that keep the nearest fragments of each pixel in order and sum up those beyond: the memory, the
// passes around the draws of the surfaces, and the resolve. How fragments come into their places is the method's.
//
// The nearest are exact, up to the rounding of the library's standard nodes; the tail beyond them is blended as the
// weighted average of Bavoil and Myers, "Order Independent Transparency with Dual Depth Peeling" (2008), whose sums are
// integers. Which fragments are the nearest does not depend on the order in which they come, nor do the sums: neither
// does one bit of the picture. Memory: layers x 8 + 24 bytes a pixel. One sample a pixel.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "../../gpu/counters.h"
#include "../../gpu/descriptors.h"
#include "../../gpu/pixel_pass.h"
#include "../method.h"

namespace vitrail::tool {

class NearestLayers : public Method {
 public:
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  FrameStats stats() const override;

 protected:
  static constexpr std::uint32_t kLayers = 8; // by default

  // Throws GpuError. `options` has the number of layers.
  NearestLayers(const MethodHost& host, const MethodOptions& options);

  // Pipelines that draw the surfaces once, with one of the method's shaders.
  SurfacePipelines makeSurfaces(const MethodHost& host, std::span<const std::uint32_t> shader,
                                const std::string& name) const;
  // Draws the surfaces with them in a scope of their own. Outside a rendering scope.
  void drawOnce(Frame& frame, const SurfacePipelines& surfaces) const;

 private:
  // Draws the surfaces, in one or more passes.
  virtual void drawSurfaces(Frame& frame) = 0;

  void clear(Frame& frame) const;
  void blend(Frame& frame) const;

  Gpu& gpu_;
  std::string method_;
  std::uint32_t layers_;
  SingleSet set_; // of the draws and the resolve
  PixelPass resolve_;
  Counters control_; // shaders::LayersControl
  VkExtent2D extent_{};
  GpuBuffer entries_;
  GpuBuffer tails_;
};

} // namespace vitrail::tool
