#include "multi_layer.h"

#include "../../gpu/accesses.h"
#include "../interlock/interlock.h"
#include "../shared/layer_memory.h"
#include "shaders/multi_layer.frag.h"
#include "shaders/multi_layer_resolve.comp.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kLayers = 4;     // by default
constexpr std::uint64_t kLayerWords = 5; // of multi_layer.glsl
constexpr VkShaderStageFlags kMultiLayerStages = VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

SurfacePipelines makeSurfaces(const MethodHost& host, VkDescriptorSetLayout set, std::uint32_t layers) {
  requireInterlock(host.gpu, "multi-layer");
  const SurfaceProgram program{.set = set, .constantBytes = sizeof(VkExtent2D), .name = "multi-layer"};
  const auto describe = [&](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = shaders::multi_layer_frag;
    info.constants = {{1, layers}};
    info.depthFormat = PictureImages::depthFormat(false);
  };
  return {host.surfaces, host.surfaces.scene().transparentDraws(), program, describe};
}

} // namespace

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
  frame.endPass("clear");
  cmdBeginScope(commands, frame.images().transparentScope({{0, 0}, extent_}));
  vkCmdPushConstants(commands, surfaces_.layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(extent_), &extent_);
  frame.drawSurfaces(surfaces_, set_.set());
  vkCmdEndRendering(commands);
  frame.endPass("collect");
  // The draw wrote the layers -> the resolve reads them.
  cmdMemoryBarrier(commands, kFragmentWrite, kComputeRead);
  frame.images().cmdToComputeResolve(commands);
  resolve_.cmdRun(commands, extent_);
  frame.endPass("resolve");
}

} // namespace vitrail::tool
