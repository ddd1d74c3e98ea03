#include "pixel_pass.h"

#include "pixel_pass_shared.h"

namespace vitrail::tool {

PixelPass::PixelPass(Gpu& gpu, const SingleSet& set, const PixelPassInfo& info)
    : set_(set.set()),
      constantBytes_(info.constantBytes),
      layout_(makePipelineLayout(gpu, {set.layout()}, {VK_SHADER_STAGE_COMPUTE_BIT, constantBytes_}, info.name)),
      pipeline_(makeComputePipeline(gpu, layout_.get(), info.shader, info.name, info.constants)) {}

void PixelPass::cmdRun(VkCommandBuffer commands, VkExtent2D extent, const void* constants) const {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1, &set_, 0, nullptr);
  if (constantBytes_ > 0) {
    vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, constantBytes_, constants);
  }
  vkCmdDispatch(commands, shaders::pixelGroups(extent.width), shaders::pixelGroups(extent.height), 1);
}

} // namespace vitrail::tool
