// Multi-layer alpha blending: Salvi and Vaidyanathan, "Multi-Layer Alpha Blending" (I3D 2014). Each pixel has a few
// layers, in order; a fragment is sorted in among them, and where that makes one too many the two farthest are merged
// into one, the farther under the nearer. One fragment of a pixel at a time, in the order of submission: fragment
// shader interlock (VK_EXT_fragment_shader_interlock), without which the method is refused.
//
// Cost: one draw of the surfaces, whose fragments of one pixel wait for each other, and read and write up to as many
// layers as there are (--layers, 4 by default), 20 bytes each; a pass that clears them and one that reads them. One
// sample a pixel.
//
// What it gets wrong: a fragment that belongs between two that have been merged comes to lie behind both, so pixels
// with more surfaces than layers depend on the order of submission: right from front to back, worst from back to front.
// It does not know where that happened. Pixels with as many surfaces as layers are exact, up to the layers' 16-bit
// floats.
#include <memory>

#include "../../gpu/accesses.h"
#include "../../gpu/pixel_pass.h"
#include "../method.h"
#include "../methods.h"
#include "../shared/device_needs.h"
#include "../shared/layer_memory.h"
#include "../shared/storing_surfaces.h"
#include "shaders/multi_layer.frag.h"
#include "shaders/multi_layer_resolve.comp.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kLayers = 4;     // by default
constexpr std::uint64_t kLayerWords = 5; // of multi_layer.glsl
constexpr VkShaderStageFlags kMultiLayerStages = VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

SurfacePipelines makeSurfaces(const MethodHost& host, VkDescriptorSetLayout set, std::uint32_t layers) {
  requireDevice(host.gpu, "multi-layer");
  const SurfaceProgram program{.set = set, .constantBytes = sizeof(VkExtent2D), .name = "multi-layer"};
  return makeStoringSurfaces(host, program, shaders::multi_layer_frag, {{1, layers}});
}

class MultiLayer final : public Method {
 public:
  MultiLayer(const MethodHost& host, const MethodOptions& options);

  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override { memory_ = GpuBuffer(); }
  void draw(Frame& frame) override;
  FrameStats stats() const override { return {.totalBytes = memory_.size()}; }

 private:
  Gpu& gpu_;
  std::uint32_t layers_;
  SingleSet set_; // of the draw and the resolve
  SurfacePipelines surfaces_;
  PixelPass resolve_;
  VkExtent2D extent_{};
  GpuBuffer memory_;
};

MultiLayer::MultiLayer(const MethodHost& host, const MethodOptions& options)
    : gpu_(host.gpu),
      layers_(options.maxLayers > 0 ? options.maxLayers : kLayers),
      set_(gpu_,
           {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kMultiLayerStages},           // layers
            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}}, // colour, of the resolve
           "multi-layer"),
      surfaces_(makeSurfaces(host, set_.layout(), layers_)),
      resolve_(
          gpu_, set_,
          {.shader = shaders::multi_layer_resolve_comp, .name = "multi-layer resolve", .constants = {{1, layers_}}}) {}

void MultiLayer::setTarget(const MethodTarget& target) {
  set_.writeImage(1, target.color, VK_IMAGE_LAYOUT_GENERAL);
  const bool kept =
      memory_.get() != VK_NULL_HANDLE && target.extent.width == extent_.width && target.extent.height == extent_.height;
  if (kept) return;
  releaseTarget();
  extent_ = target.extent;
  memory_ =
      makeLayerMemory(gpu_, extent_, {.method = "multi-layer", .layers = layers_, .words = kLayerWords * layers_});
  set_.writeBuffer(0, memory_.get(), memory_.size());
}

void MultiLayer::draw(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  // The last frame's resolve read the layers -> they are cleared.
  cmdMemoryBarrier(commands, {kComputeRead.stages, VK_ACCESS_2_NONE}, kClear);
  vkCmdFillBuffer(commands, memory_.get(), 0, memory_.size(), 0);
  // The clear -> the draw reads and writes the layers.
  cmdMemoryBarrier(commands, kClear, kFragmentReadWrite);
  frame.endStep("clear");
  cmdDrawStoring(frame, surfaces_, set_.set(), &extent_);
  frame.endStep("collect");
  // The draw wrote the layers -> the resolve reads them.
  cmdMemoryBarrier(commands, kFragmentWrite, kComputeRead);
  frame.images().cmdToComputeResolve(commands);
  resolve_.cmdRun(commands, extent_);
  frame.endPass("resolve");
}

} // namespace

std::unique_ptr<Method> makeMultiLayer(const MethodHost& host, const MethodOptions& options) {
  return std::make_unique<MultiLayer>(host, options);
}

} // namespace vitrail::tool
