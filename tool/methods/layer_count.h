// Counts the transparent fragments of every pixel that opaque surfaces do not hide: the depth complexity, and what
// linked-list stores with hdr nodes. No method to draw with: its picture is the opaque scene, and the counts are
// MethodStats::pixelLayers. Costs one atomic addition a fragment and four bytes a pixel. One sample a pixel.
#pragma once

#include "../draw/descriptors.h"
#include "../draw/resources.h"
#include "method.h"

namespace vitrail::tool {

inline constexpr std::string_view kLayerCount = "layer-count"; // what makeMethod() makes; not among methodNames()

class LayerCount final : public Method {
 public:
  // Throws GpuError.
  explicit LayerCount(Gpu& gpu);

  std::string_view name() const override { return kLayerCount; }
  MethodNeeds needs() const override { return {}; }
  SurfaceDrawing surface(std::uint32_t features) const override;
  VkDescriptorSetLayout surfaceLayout() const override { return set_.layout(); }
  VkDescriptorSet surfaceSet() const override { return set_.set(); }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void cmdBegin(VkCommandBuffer commands, std::uint64_t frame, const VkRect2D& area) override;
  void cmdCollected(VkCommandBuffer commands) override;
  MethodStats stats() const override;

 private:
  Gpu& gpu_;
  SingleSet set_;
  VkExtent2D extent_{};
  GpuImage counts_;
  GpuBuffer readback_; // a copy of them
};

} // namespace vitrail::tool
