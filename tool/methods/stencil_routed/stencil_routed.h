// The stencil-routed A-buffer: Myers and Bavoil, "Stencil Routed A-Buffer" (SIGGRAPH 2007 sketches). The fragments of a
// pixel go to the samples of a multisampled image. All samples see all fragments; the stencil of each counts down from
// a number of its own, and lets the sample be written until the fragment that it is for has come. When all surfaces
// have been drawn the samples are sorted and blended. As many layers a pass as the device has samples, up to 8, and as
// many passes as the deepest pixel needs, which is measured (depth_complexity.h), each with other numbers.
//
// All samples of a pixel must be covered by what covers its middle. The method was made with multisampling switched off
// while drawing into multisampled images, which Vulkan has not; VK_EXT_sample_locations puts all samples into the
// middle instead. Where the device lacks it each sample is drawn by itself, with the scene moved so that the middle of
// the pixel falls on the sample.
//
// Cost: n / s draws of the surfaces for n layers in the deepest pixel and s samples, or n where samples are drawn by
// themselves, each fragment shaded once in each until all samples that it reaches are full; 28 s bytes a pixel for the
// samples and 20 n for the layers of all passes; the blending of n fragments reads them n / 16 times. One sample a
// pixel in the picture.
//
// What it gets wrong: a stencil counts to 255, so more than 254 surfaces in a pixel are refused. Each layer is kept in
// 16-bit floats. Where samples are drawn by themselves the moved scene may be rounded otherwise, so a pixel whose
// middle is as good as on an edge may lose or repeat a fragment: such pictures are reported as not exact.
#pragma once

#include <array>
#include <vector>

#include "../../gpu/pixel_pass.h"
#include "../method.h"
#include "../shared/depth_complexity.h"

namespace vitrail::tool {

class StencilRouted final : public Method {
 public:
  // Throws GpuError.
  explicit StencilRouted(const MethodHost& host);

  std::string_view name() const override { return "stencil-routed"; }
  std::string_view resolve() const override { return "compute"; }
  MethodNeeds needs() const override { return DepthComplexity::kNeeds; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  MethodStats stats() const override;

 private:
  GraphicsPipelineInfo beginPipeline(const std::string& name) const;
  SurfacePipelines makeSurfaces(const MethodHost& host, std::uint32_t sampleMask) const;
  void makeLayers(std::uint32_t count);
  void route(Frame& frame, std::uint32_t firstLayer);
  void drawSamples(Frame& frame);
  void keep(Frame& frame, std::uint32_t firstLayer);
  void blend(Frame& frame);

  Gpu& gpu_;
  bool inMiddle_;         // the samples, all of them
  std::uint32_t samples_; // of a pixel
  DepthComplexity complexity_;
  SingleSet beginSet_;
  SingleSet layersSet_; // of the passes that keep and blend layers
  Unique<VkPipelineLayout> beginLayout_;
  Unique<VkPipeline> beginDepth_;
  std::vector<Unique<VkPipeline>> beginStencil_; // adds 1 to all samples but the first, the first two, ...
  std::vector<SurfacePipelines> surfaces_;       // of all samples, or of each
  PixelPass keep_;
  PixelPass blend_;
  VkExtent2D extent_{};
  UsedImage depth_;                  // with the stencil
  std::array<UsedImage, 3> sampled_; // colour, opacity and depth, of the samples
  std::array<UsedImage, 3> layers_;  // the same of all passes
};

} // namespace vitrail::tool
