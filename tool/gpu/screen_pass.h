// A fragment shader that runs once for every pixel of a scope: one triangle over the viewport.
#pragma once

#include <span>
#include <string>

#include "pipeline.h"

namespace vitrail::tool {

// A pipeline without outputs, tests and vertex data, to be completed; then makeGraphicsPipeline() makes it.
GraphicsPipelineInfo screenPipeline(VkPipelineLayout layout, std::span<const std::uint32_t> fragmentShader,
                                    const std::string& name);

// Draws the triangle. Sets and push constants have been bound for the pipeline's layout.
void cmdDrawScreen(VkCommandBuffer commands, VkPipeline pipeline);

} // namespace vitrail::tool
