// Draws pictures on the processor, by Vitrail's own rasteriser: the method `cpu`. No Vulkan, no driver.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <vitrail/cpu.h>

#include "../methods/method_options.h"
#include "../stage/draw_order.h"
#include "renderer.h"

namespace vitrail::tool {

// The longest side of a picture.
inline constexpr std::uint32_t kMaxProcessorSide = VITRAIL_CPU_MAX_SIDE;

// The processor, its vector instructions and the threads that draw: "AMD EPYC (AVX2, 2 threads)". Throws GpuError where
// the rasteriser cannot be made.
std::string processorDevice();

// Holds one scene. Pictures of 8 bits over a colour are encoded as they are drawn. Others are drawn in linear light, in
// bands of rows where they have more than 16 M pixels, so that little more than the encoded picture is in memory; they
// are the same.
class CpuStillRenderer final : public Renderer {
 public:
  // As StillRenderer's; the method is `cpu`, or layer-count for measure() alone. Throws GpuError. The scene need not
  // outlive it.
  CpuStillRenderer(const Scene& scene, std::optional<float> opacity, DrawOrder order, const MethodOptions& method);
  CpuStillRenderer(Scene&& scene, std::optional<float> opacity, const MethodOptions& method);
  ~CpuStillRenderer() override;

  RenderResult render(const RenderOptions& options) override;
  FrameReport measure(const RenderOptions& options) override;

 private:
  struct Impl;
  struct Totals;
  std::unique_ptr<Impl> impl_;
};

} // namespace vitrail::tool
