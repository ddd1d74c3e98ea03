#include "storing_surfaces.h"

namespace vitrail::tool {

SurfacePipelines makeStoringSurfaces(const MethodHost& host, const SurfaceProgram& program,
                                     std::span<const std::uint32_t> fragmentShader,
                                     const PipelineConstants& constants) {
  const auto describe = [&](std::uint32_t /*features*/, GraphicsPipelineInfo& info) {
    info.fragmentShader = fragmentShader;
    info.constants = constants;
    info.depthFormat = PictureImages::depthFormat(false);
  };
  return {host.surfaces, host.surfaces.scene().transparentDraws(), program, describe};
}

void cmdDrawStoring(Frame& frame, const SurfacePipelines& surfaces, VkDescriptorSet set, const VkExtent2D* extent) {
  PictureImages& images = frame.images();
  cmdBeginScope(frame.commands(), images.transparentScope({{0, 0}, images.extent()}));
  if (extent != nullptr) {
    vkCmdPushConstants(frame.commands(), surfaces.layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(*extent), extent);
  }
  frame.drawSurfaces(surfaces, set);
  vkCmdEndRendering(frame.commands());
}

} // namespace vitrail::tool
