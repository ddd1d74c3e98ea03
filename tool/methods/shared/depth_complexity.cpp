#include "depth_complexity.h"

#include <fmt/format.h>

#include "../../gpu/accesses.h"
#include "complexity_steps.h"
#include "shaders/complexity_count.frag.h"
#include "shaders/complexity_count_wide.frag.h"
#include "shaders/complexity_reduce.comp.h"

namespace vitrail::tool {

namespace {

Gpu& withStencil(Gpu& gpu, const std::string& method) {
  if (gpu.features().stencil) return gpu;
  throw GpuError(fmt::format("{} has no stencil beside a depth of 32 bits, which the method {} counts surfaces in",
                             gpu.properties().deviceName, method));
}

SurfacePipelines makeInStencil(const MethodHost& host) {
  const auto describe = [](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = shaders::complexity_count_frag;
    info.depthFormat = PictureImages::depthFormat(true);
    info.stencil = VkStencilOpState{.failOp = VK_STENCIL_OP_KEEP,
                                    .passOp = VK_STENCIL_OP_INCREMENT_AND_CLAMP,
                                    .depthFailOp = VK_STENCIL_OP_KEEP,
                                    .compareOp = VK_COMPARE_OP_ALWAYS,
                                    .compareMask = 0xff,
                                    .writeMask = 0xff,
                                    .reference = 0};
  };
  return {host.surfaces, host.surfaces.scene().transparentDraws(), {.name = "count"}, describe};
}

SurfacePipelines makeInImage(const MethodHost& host, VkDescriptorSetLayout set) {
  const auto describe = [](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = shaders::complexity_count_wide_frag;
    info.depthFormat = PictureImages::depthFormat(true);
  };
  return {host.surfaces, host.surfaces.scene().transparentDraws(), {.set = set, .name = "count in 32 bits"}, describe};
}

} // namespace

DepthComplexity::DepthComplexity(const MethodHost& host, const std::string& method)
    : gpu_(withStencil(host.gpu, method)),
      countSet_(gpu_, {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT}}, "count"),
      reduceSet_(gpu_,
                 {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},   // stencil
                  {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},   // counts
                  {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT}}, // parts
                 "depth complexity"),
      inStencil_(makeInStencil(host)),
      inImage_(makeInImage(host, countSet_.layout())),
      layout_(makePipelineLayout(gpu_, {reduceSet_.layout()},
                                 {VK_SHADER_STAGE_COMPUTE_BIT, sizeof(shaders::ComplexityReduction)},
                                 "depth complexity")),
      reduce_(makeComputePipeline(gpu_, layout_.get(), shaders::complexity_reduce_comp, "depth complexity")) {}

void DepthComplexity::setTarget(const MethodTarget& target) {
  extent_ = target.extent;
  const std::uint64_t bytes = complexityParts(extent_.width * extent_.height) * sizeof(shaders::Complexity);
  if (parts_.buffer().size() != bytes) parts_ = Counters(gpu_, bytes, "depth complexity");
  if (counts_.get().get() == VK_NULL_HANDLE) makeCounts({1, 1});
  reduceSet_.writeImage(0, target.stencil, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  reduceSet_.writeBuffer(2, parts_.buffer().get(), bytes);
}

void DepthComplexity::releaseTarget() { counts_ = UsedImage(); }

// No command buffer that uses them is pending.
void DepthComplexity::makeCounts(VkExtent2D extent) {
  GpuImageInfo info;
  info.extent = extent;
  info.format = VK_FORMAT_R32_UINT;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  if (!counts_.ensure(gpu_, info, "counts of surfaces")) return;
  countSet_.writeImage(0, counts_.get().view(), VK_IMAGE_LAYOUT_GENERAL);
  reduceSet_.writeImage(1, counts_.get().view(), VK_IMAGE_LAYOUT_GENERAL);
}

void DepthComplexity::measure(Frame& frame, std::uint32_t nearest) {
  countInStencil(frame);
  reduce(frame, shaders::COMPLEXITY_STENCIL, nearest);
  if (measured_.deepest < shaders::COMPLEXITY_SATURATED) return;
  makeCounts(extent_);
  countInImage(frame);
  reduce(frame, shaders::COMPLEXITY_IMAGE, nearest);
}

void DepthComplexity::countInStencil(Frame& frame) {
  PictureImages& images = frame.images();
  cmdBeginScope(frame.commands(), images.transparentScope({{0, 0}, images.extent()}));
  frame.drawSurfaces(inStencil_);
  vkCmdEndRendering(frame.commands());
}

void DepthComplexity::countInImage(Frame& frame) {
  VkCommandBuffer commands = frame.commands();
  // Who used the counts last -> they are cleared.
  counts_.cmdClear(commands, {});
  // The clear wrote -> the surfaces are counted.
  counts_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kFragmentReadWrite);
  Scope scope = frame.images().wholeScope();
  scope.depth = {.image = &frame.images().depth(), .depth = AspectUse::Test};
  cmdBeginScope(commands, scope);
  frame.drawSurfaces(inImage_, countSet_.set());
  vkCmdEndRendering(commands);
}

void DepthComplexity::reduce(Frame& frame, std::uint32_t source, std::uint32_t nearest) {
  VkCommandBuffer commands = frame.commands();
  // The draws wrote counts, or the stencil -> the first step reads it.
  counts_.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeRead);
  frame.images().depth().cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, kComputeSample);
  // The last copy read -> the parts are written.
  cmdMemoryBarrier(commands, {kCopyRead.stages, VK_ACCESS_2_NONE}, kComputeReadWrite);
  const VkDescriptorSet set = reduceSet_.set();
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, reduce_.get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1, &set, 0, nullptr);
  for (const ComplexityStep& step : complexitySteps(extent_.width, extent_.height, source, nearest)) {
    vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(step.constants),
                       &step.constants);
    vkCmdDispatch(commands, step.columns, step.rows, 1);
    // A step wrote parts -> the next one reads them.
    cmdMemoryBarrier(commands, kComputeWrite, kComputeReadWrite);
  }
  parts_.cmdRead(commands, kComputeWrite);
  frame.endPass("count");
  frame.submitAndWait();
  measured_ = parts_.read<shaders::Complexity>();
}

FrameStats DepthComplexity::stats() const {
  FrameStats stats = complexityStats(measured_);
  const VkExtent2D counts = counts_.get().info().extent;
  stats.totalBytes = parts_.bytes() + std::uint64_t{counts.width} * counts.height * sizeof(std::uint32_t);
  return stats;
}

} // namespace vitrail::tool
