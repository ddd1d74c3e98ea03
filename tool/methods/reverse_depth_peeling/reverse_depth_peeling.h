// Depth peeling, back to front: Thibieroz, "Robust Order-Independent Transparency via Reverse Depth Peeling in DirectX
// 10" (ShaderX6, 2008). Each pass finds the farthest depth in front of the layer before it, and blends the surfaces at
// that depth straight into the picture, by fixed function. As many passes as the deepest pixel has surfaces, which is
// measured (depth_complexity.h): a picture that stops early lacks its nearest layers, so there is no --layers.
//
// All surfaces of a pixel at equal depths are one layer and are blended in one pass: none is lost.
//
// Cost: 2 n draws of the surfaces for n layers in the deepest pixel, n of which find depths and shade masked surfaces
// only; the others shade each fragment once in the frame. Two depth images, 8 bytes a pixel, and no colour but the
// picture's. One sample a pixel.
//
// What it gets wrong: of surfaces at equal depths the one that is drawn last counts as nearer, so there, and only
// there, the order of submission shows. The picture's 16-bit floats round after each layer.
#pragma once

#include <array>

#include "../method.h"
#include "../shared/depth_complexity.h"

namespace vitrail::tool {

class ReverseDepthPeeling final : public Method {
 public:
  // Throws GpuError.
  ReverseDepthPeeling(const MethodHost& host, const MethodOptions& options);

  std::string_view name() const override { return "reverse-depth-peeling"; }
  MethodNeeds needs() const override { return DepthComplexity::kNeeds; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  MethodStats stats() const override;

 private:
  void find(Frame& frame, UsedImage& last, UsedImage& found, VkDescriptorSet lastSet);
  void blend(Frame& frame, UsedImage& found, VkDescriptorSet lastSet);

  Gpu& gpu_;
  DepthComplexity complexity_;
  std::array<SingleSet, 2> sets_; // of each of the depths below, as the last layer's
  SingleSet opaqueSet_;           // of the opaque scene's, which the first pass begins at
  SurfacePipelines find_;
  SurfacePipelines blend_;
  VkExtent2D extent_{};
  std::array<UsedImage, 2> depths_; // of the last layer and the present one, in turns
};

} // namespace vitrail::tool
