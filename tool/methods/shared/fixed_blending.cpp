#include "fixed_blending.h"

#include <fmt/format.h>

#include "../../stage/surface_shared.h"
#include "shaders/fixed_blending.frag.h"
#include "shaders/fixed_blending_transmission.frag.h"

namespace vitrail::tool {

SurfacePipelines makeBlendedSurfaces(const MethodHost& host, const MethodOptions& options, const std::string& method) {
  return makeBlendedSurfaces(host, options, {.name = method}, [](std::uint32_t, GraphicsPipelineInfo&) {});
}

SurfacePipelines makeBlendedSurfaces(const MethodHost& host, const MethodOptions& options,
                                     const SurfaceProgram& program, const SurfacePipelines::Describe& adjust) {
  const auto describe = [&](std::uint32_t features, GraphicsPipelineInfo& info) {
    const bool transmissive = (features & shaders::FEATURE_TRANSMISSION) != 0;
    if (transmissive && !host.gpu.features().dualSourceBlending) {
      throw GpuError(
          fmt::format("{} has no dual-source blending, which the method {} needs for surfaces that transmit light",
                      host.gpu.properties().deviceName, program.name));
    }
    // The shader's first output plus what is there times the factor.
    const BlendFactors over{VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA};
    const BlendFactors color{VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_SRC1_COLOR};
    const BlendFactors alpha{VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_SRC1_ALPHA};
    info.fragmentShader = shaders::fixed_blending_frag;
    if (transmissive) info.fragmentShader = shaders::fixed_blending_transmission_frag;
    info.samples = flagOf(options.samples);
    info.colors = {{PictureImages::kColorFormat, transmissive ? blendWith(color, alpha) : blendWith(over, over)}};
    info.depthFormat = PictureImages::depthFormat(false);
    adjust(features, info);
  };
  return {host.surfaces, host.surfaces.scene().transparentDraws(), program, describe};
}

void cmdBeginBlending(Frame& frame) {
  PictureImages& images = frame.images();
  Scope scope = images.transparentScope({{0, 0}, images.extent()});
  scope.colors.push_back({.image = &images.drawn()});
  cmdBeginScope(frame.commands(), scope);
}

} // namespace vitrail::tool
