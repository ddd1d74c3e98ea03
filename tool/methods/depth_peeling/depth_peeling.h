// Depth peeling, front to back: Everitt, "Interactive Order-Independent Transparency" (NVIDIA 2001). Each pass draws
// all surfaces, leaves out those that earlier passes took, and keeps the nearest of the rest by the depth test; it is
// then blended under the layers before it. As many passes as the deepest pixel has surfaces, which is measured
// (depth_complexity.h), or fewer: then the nearest are drawn and the rest is missing, which the report says.
//
// Surfaces of one pixel at equal depths, which peeling by depth alone takes for one, are told apart by the number of
// their triangle: none is lost.
//
// Cost: n draws of the surfaces for n layers in the deepest pixel, as many times all fragments through the depth test;
// what has textures is shaded in each, since neighbours take derivatives. Seven images of the picture's size, 68 bytes
// a pixel, however many layers there are. One sample a pixel.
//
// What it gets wrong: of surfaces at equal depths the one that is drawn first counts as nearer, so there, and only
// there, the order of submission shows. Each layer is kept in 16-bit floats.
#pragma once

#include "../../gpu/pixel_pass.h"
#include "../method.h"
#include "../shared/depth_complexity.h"

namespace vitrail::tool {

class DepthPeeling final : public Method {
 public:
  // Throws GpuError.
  DepthPeeling(const MethodHost& host, const MethodOptions& options);

  std::string_view name() const override { return "depth-peeling"; }
  MethodNeeds needs() const override { return DepthComplexity::kNeeds; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  MethodStats stats() const override;

 private:
  void clear(Frame& frame);
  void peel(Frame& frame);
  void blend(Frame& frame, std::uint32_t step);

  Gpu& gpu_;
  std::uint32_t layers_; // 0: all
  DepthComplexity complexity_;
  SingleSet peelSet_;
  SingleSet blendSet_;
  SurfacePipelines surfaces_;
  PixelPass blend_;
  VkExtent2D extent_{};
  UsedImage depth_; // of the layer that a pass takes
  UsedImage color_;
  UsedImage opacity_;
  UsedImage layerTaken_;
  UsedImage frontColor_; // of the layers before it
  UsedImage frontThrough_;
  UsedImage taken_;
};

} // namespace vitrail::tool
