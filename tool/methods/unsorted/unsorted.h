// Plain alpha blending in the order of submission, by fixed function: what a renderer without order-independent
// transparency does, wrong wherever a nearer surface comes first. Every cost is compared with it.
//
// Cost: one draw of the surfaces, whose every fragment reads and writes the colour once. No memory.
#pragma once

#include "../method.h"

namespace vitrail::tool {

class Unsorted final : public Method {
 public:
  // Throws GpuError.
  Unsorted(const MethodHost& host, const MethodOptions& options);

  std::string_view name() const override { return "unsorted"; }
  MethodNeeds needs() const override { return {.perSample = true}; }
  void draw(Frame& frame) override;
  MethodStats stats() const override { return {.counted = false}; }

 private:
  SurfacePipelines surfaces_;
};

} // namespace vitrail::tool
