// An A-buffer as linear arrays: Carpenter, "The A-buffer, an antialiased hidden surface method" (SIGGRAPH 1984), whose
// per-pixel lists are here arrays of the right length, as in Lipowski, "Multi-layered framebuffer condensation: the
// l-buffer concept" (ICCVG 2010), and Vasilakos and Fudos, "S-buffer: Sparsity-aware multi-fragment rendering"
// (Eurographics 2012). A first geometry pass counts each pixel's fragments, a prefix sum over the image gives each
// pixel the start of its array, a second geometry pass fills the arrays, and a resolve sorts and blends them. Any
// number of fragments in a pixel.
//
// Cost: two draws of the surfaces, the first of which shades masked surfaces only, with an atomic operation a fragment
// in each; the prefix sum reads and writes each pixel's count about twice; the resolve of n fragments reads them
// n / 16 times. Memory: 8 bytes a fragment, the 12 of the library's standard node without the next pointer, and 8 bytes
// a pixel. A picture that has more fragments than the last one had room for is drawn again. One sample a pixel.
//
// What it gets wrong: nothing, but for the rounding of standard nodes: colours in 8 bits on the sRGB curve, none
// brighter than white. It holds the whole picture's fragments at once, and refuses where the device cannot.
#pragma once

#include <cstdint>

#include "../../gpu/counters.h"
#include "../../gpu/descriptors.h"
#include "../../gpu/pixel_pass.h"
#include "../method.h"
#include "../shared/fragment_pool.h"
#include "a_buffer_shared.h"

namespace vitrail::tool {

class ABuffer final : public Method {
 public:
  // Throws GpuError.
  explicit ABuffer(const MethodHost& host);

  std::string_view name() const override { return "a-buffer"; }
  std::string_view resolve() const override { return "compute"; }
  MethodNeeds needs() const override { return {}; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  bool finish() override;
  MethodStats stats() const override;

 private:
  void clear(Frame& frame);
  void drawGeometry(Frame& frame, const SurfacePipelines& pipelines);
  void sumUp(Frame& frame);
  void cmdScan(VkCommandBuffer commands, VkPipeline pipeline, const shaders::ABufferScan& scan);
  void sortAndBlend(Frame& frame);

  Gpu& gpu_;
  SingleSet set_; // of all passes
  SurfacePipelines count_;
  SurfacePipelines fill_;
  Unique<VkPipelineLayout> scanLayout_;
  Unique<VkPipeline> scan_;
  Unique<VkPipeline> add_;
  PixelPass resolve_;
  Counters control_; // shaders::ABufferControl
  FragmentPool fragments_;
  VkExtent2D extent_{};
  GpuBuffer offsets_; // counts at first; the sums of work groups behind them
  GpuBuffer filled_;
  std::uint32_t total_ = 0; // where in offsets_ the sum of all counts is
};

} // namespace vitrail::tool
