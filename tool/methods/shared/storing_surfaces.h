// Surfaces whose fragments go into buffers or images instead of attachments: drawn over the whole picture, one sample a
// pixel, those in front of the opaque scene.
#pragma once

#include <span>

#include "../method.h"

namespace vitrail::tool {

// Pipelines of all transparent surfaces. `constants` are the fragment shader's specialization constants beside the
// features.
SurfacePipelines makeStoringSurfaces(const MethodHost& host, const SurfaceProgram& program,
                                     std::span<const std::uint32_t> fragmentShader,
                                     const PipelineConstants& constants = {});

// Draws them in a scope of their own. `set` is set 2 of the pipelines; `extent`, where there is one, their push
// constants. Outside a rendering scope.
void cmdDrawStoring(Frame& frame, const SurfacePipelines& surfaces, VkDescriptorSet set,
                    const VkExtent2D* extent = nullptr);

} // namespace vitrail::tool
