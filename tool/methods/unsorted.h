// Plain alpha blending in the order of submission, by fixed function: what a renderer without order-independent
// transparency does, wrong wherever a nearer surface comes first. Every cost is compared with it.
#pragma once

#include "../draw/device.h"
#include "method.h"

namespace vitrail::tool {

class Unsorted final : public Method {
 public:
  explicit Unsorted(Gpu& gpu) : gpu_(gpu) {}

  std::string_view name() const override { return "unsorted"; }
  MethodNeeds needs() const override { return {.blending = Blending::AsDrawn, .perSample = true}; }
  // Transmissive surfaces take dual-source blending: one draw both tints what is behind and adds the reflection. Throws
  // GpuError where the device has none.
  SurfaceDrawing surface(std::uint32_t features) const override;
  void setTarget(const MethodTarget& /*target*/) override {}
  void releaseTarget() override {}
  MethodStats stats() const override;

 private:
  Gpu& gpu_;
};

} // namespace vitrail::tool
