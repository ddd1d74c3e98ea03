// The way of most published samples of per-pixel linked lists, as a baseline for the library's resolve: one thread a
// pixel copies the list into an array, sorts it by insertion, and blends it. All pixels pay for an array that is as
// large as the longest list that is to be right, and what a list has beyond it is dropped: those frames are reported as
// not exact, with the fragments that are missing. A counter that only rises hands out the nodes, which is wrong from
// 2^32 fragments in a frame. One sample a pixel, no tiles.
#pragma once

#include <cstdint>

#include "../draw/descriptors.h"
#include "../draw/pipeline.h"
#include "../draw/resources.h"
#include "../draw/shaders/insertion_shared.h"
#include "method.h"

namespace vitrail::tool {

class Insertion final : public Method {
 public:
  // Throws GpuError.
  explicit Insertion(Gpu& gpu);

  std::string_view name() const override { return "insertion"; }
  MethodNeeds needs() const override { return {}; }
  SurfaceDrawing surface(std::uint32_t features) const override;
  VkDescriptorSetLayout surfaceLayout() const override { return set_.layout(); }
  VkDescriptorSet surfaceSet() const override { return set_.set(); }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void cmdBegin(VkCommandBuffer commands, std::uint64_t frame, const VkRect2D& area) override;
  void cmdCollected(VkCommandBuffer commands) override;
  void cmdResolve(VkCommandBuffer commands) override;
  void cmdEnd(VkCommandBuffer commands) override;
  bool finishArea(std::uint64_t frame) override;
  MethodStats stats() const override;

 private:
  std::uint64_t mostNodes() const;
  void makePool(std::uint64_t nodes);

  Gpu& gpu_;
  SingleSet set_; // of both passes
  Unique<VkPipelineLayout> layout_;
  Unique<VkPipeline> resolve_;
  GpuBuffer control_;  // shaders::InsertionControl
  GpuBuffer readback_; // a copy of it
  MethodTarget target_;
  GpuImage heads_;
  GpuBuffer nodes_;
  std::uint64_t capacity_ = 0;
};

} // namespace vitrail::tool
