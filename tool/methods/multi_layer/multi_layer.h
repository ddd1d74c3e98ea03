// Multi-layer alpha blending: Salvi and Vaidyanathan, "Multi-Layer Alpha Blending" (I3D 2014). Each pixel has a few
// layers, in order; a fragment is sorted in among them, and where that makes one too many the two farthest are merged
// into one, the farther under the nearer. One fragment of a pixel at a time, in the order of submission: fragment
// shader interlock (VK_EXT_fragment_shader_interlock), without which the method is refused.
//
// Cost: one draw of the surfaces, whose fragments of one pixel wait for each other, and read and write up to as many
// layers as there are (--layers, 4 by default), 20 bytes each; a pass that clears them and one that reads them. One
// sample a pixel.
//
// What it gets wrong: a fragment that belongs between two that have been merged comes to lie behind both, so pixels
// with more surfaces than layers depend on the order of submission: right from front to back, worst from back to front.
// It does not know where that happened. Pixels with as many surfaces as layers are exact, up to the layers' 16-bit
// floats.
#pragma once

#include "../../gpu/pixel_pass.h"
#include "../method.h"

namespace vitrail::tool {

class MultiLayer final : public Method {
 public:
  // Throws GpuError.
  MultiLayer(const MethodHost& host, const MethodOptions& options);

  std::string_view name() const override { return "multi-layer"; }
  MethodNeeds needs() const override { return {}; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override { memory_ = GpuBuffer(); }
  void draw(Frame& frame) override;
  MethodStats stats() const override { return {.counted = false, .totalBytes = memory_.size()}; }

 private:
  Gpu& gpu_;
  std::uint32_t layers_;
  SingleSet set_; // of the draw and the resolve
  SurfacePipelines surfaces_;
  PixelPass resolve_;
  VkExtent2D extent_{};
  GpuBuffer memory_;
};

} // namespace vitrail::tool
