// Counts the transparent fragments of every pixel that opaque surfaces do not hide: the depth complexity, and what
// linked-list stores with hdr nodes. No method to draw with: its picture is the opaque scene, and the counts are
// MethodStats::pixelLayers. Costs one atomic addition a fragment and four bytes a pixel. One sample a pixel.
#pragma once

#include "../../gpu/descriptors.h"
#include "../../gpu/used_image.h"
#include "../method.h"

namespace vitrail::tool {

inline constexpr std::string_view kLayerCount = "layer-count"; // what makeMethod() makes; not among methodNames()

class LayerCount final : public Method {
 public:
  // Throws GpuError.
  explicit LayerCount(const MethodHost& host);

  std::string_view name() const override { return kLayerCount; }
  MethodNeeds needs() const override { return {}; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  MethodStats stats() const override;

 private:
  Gpu& gpu_;
  SingleSet set_;
  SurfacePipelines surfaces_;
  VkExtent2D extent_{};
  UsedImage counts_;
  GpuBuffer readback_; // a copy of them
};

} // namespace vitrail::tool
