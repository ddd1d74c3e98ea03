#include "screen_pass.h"

#include "shaders/screen.vert.h"

namespace vitrail::tool {

GraphicsPipelineInfo screenPipeline(VkPipelineLayout layout, std::span<const std::uint32_t> fragmentShader,
                                    const std::string& name) {
  GraphicsPipelineInfo info;
  info.layout = layout;
  info.vertexShader = shaders::screen_vert;
  info.fragmentShader = fragmentShader;
  info.name = name;
  return info;
}

void cmdDrawScreen(VkCommandBuffer commands, VkPipeline pipeline) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  vkCmdDraw(commands, 3, 1, 0, 0);
}

} // namespace vitrail::tool
