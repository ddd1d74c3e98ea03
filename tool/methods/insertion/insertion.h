// The way of most published samples of per-pixel linked lists, as a baseline for the library's resolve: one thread a
// pixel copies the list into an array, sorts it by insertion, and blends it. All pixels pay for an array that is as
// large as the longest list that is to be right, and what a list has beyond it is dropped: those frames are reported as
// not exact, with the fragments that are missing. A counter that only rises hands out the nodes, which is wrong from
// 2^32 fragments in a frame. One sample a pixel, no tiles.
#pragma once

#include <cstdint>

#include "../../gpu/counters.h"
#include "../../gpu/descriptors.h"
#include "../../gpu/pixel_pass.h"
#include "../../gpu/used_image.h"
#include "../method.h"
#include "../shared/fragment_pool.h"
#include "insertion_shared.h"

namespace vitrail::tool {

class Insertion final : public Method {
 public:
  // Throws GpuError.
  explicit Insertion(const MethodHost& host);

  std::string_view name() const override { return "insertion"; }
  std::string_view resolve() const override { return "compute"; }
  MethodNeeds needs() const override { return {}; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  bool finish() override;
  MethodStats stats() const override;

 private:
  void clear(Frame& frame);
  void collect(Frame& frame);
  void sortAndBlend(Frame& frame);

  Gpu& gpu_;
  SingleSet set_; // of both passes
  SurfacePipelines surfaces_;
  PixelPass resolve_;
  Counters control_; // shaders::InsertionControl
  VkExtent2D extent_{};
  UsedImage heads_;
  FragmentPool nodes_;
};

} // namespace vitrail::tool
