// How many transparent surfaces each pixel has in front of the opaque scene: what tells methods of several passes when
// to stop. A geometry pass that is tested against the opaque depth increments the stencil for each fragment, and a
// parallel reduction over the image, in work groups that halve it at each step, finds the most and the sums. Where the
// 8 bits of a stencil saturate, at 255, the surfaces are drawn once more and counted in 32 bits a pixel.
//
// Cost: one draw of the surfaces without shading (masked ones are shaded), a read of the stencil, and a wait for the
// result. A surface that transmits light counts once, though fragment lists keep two fragments of it; so does one that
// changes nothing because its alpha is 0, which lists leave out.
#pragma once

#include <cstdint>
#include <string>

#include "../../gpu/counters.h"
#include "../../gpu/descriptors.h"
#include "../../gpu/used_image.h"
#include "../method.h"
#include "complexity_shared.h"

namespace vitrail::tool {

class DepthComplexity {
 public:
  // `method` is who needs it. Throws GpuError where the device has no stencil beside a depth of 32 bits.
  DepthComplexity(const MethodHost& host, const std::string& method);

  // What its methods need at least.
  static constexpr ImageNeeds kNeeds{.stencil = true, .depthUsage = VK_IMAGE_USAGE_SAMPLED_BIT};

  // How often its methods draw the surfaces in one submission, with a pass for the draw and one for what follows it.
  // They then wait, so that no submission takes too long.
  static constexpr std::uint32_t kRounds = 24;
  static_assert(2 * kRounds + 8 < Frame::kMostPasses); // and some for what comes before and after

  void setTarget(const MethodTarget& target);
  void releaseTarget();

  // Counts in passes "count" of the frame, whose stencil is 0, and waits for the result: stats() and deepest() of the
  // frame. `nearest` surfaces of a pixel will be drawn, 0: all.
  void measure(Frame& frame, std::uint32_t nearest = 0);

  std::uint32_t deepest() const { return measured_.deepest; }
  // What was counted; exact where no surface is left out. Bytes are those of the counting.
  FrameStats stats() const;

 private:
  void makeCounts(VkExtent2D extent);
  void countInStencil(Frame& frame);
  void countInImage(Frame& frame);
  void reduce(Frame& frame, std::uint32_t source, std::uint32_t nearest);

  Gpu& gpu_;
  SingleSet countSet_; // of the surfaces that are counted in 32 bits
  SingleSet reduceSet_;
  SurfacePipelines inStencil_;
  SurfacePipelines inImage_;
  Unique<VkPipelineLayout> layout_;
  Unique<VkPipeline> reduce_;
  VkExtent2D extent_{};
  UsedImage counts_; // one pixel where the stencil suffices
  Counters parts_;   // shaders::Complexity; the result first
  shaders::Complexity measured_{};
};

} // namespace vitrail::tool
