#include "unsorted.h"

#include <fmt/format.h>

#include "../draw/shaders/shared.h"
#include "shaders/unsorted.frag.h"
#include "shaders/unsorted_transmission.frag.h"

namespace vitrail::tool {

namespace {

// The shader's first output plus what is there times the factors.
VkPipelineColorBlendAttachmentState blendWith(VkBlendFactor color, VkBlendFactor alpha) {
  VkPipelineColorBlendAttachmentState state{};
  state.blendEnable = VK_TRUE;
  state.srcColorBlendFactor = VK_BLEND_FACTOR_ONE;
  state.dstColorBlendFactor = color;
  state.colorBlendOp = VK_BLEND_OP_ADD;
  state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  state.dstAlphaBlendFactor = alpha;
  state.alphaBlendOp = VK_BLEND_OP_ADD;
  state.colorWriteMask =
      VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  return state;
}

} // namespace

SurfaceDrawing Unsorted::surface(std::uint32_t features) const {
  SurfaceDrawing drawing;
  if ((features & shaders::FEATURE_TRANSMISSION) == 0) {
    drawing.fragmentShader = shaders::unsorted_frag;
    drawing.blend = blendWith(VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA);
    return drawing;
  }
  if (!gpu_.features().dualSourceBlending) {
    throw GpuError(
        fmt::format("{} has no dual-source blending, which the method unsorted needs for surfaces that transmit light",
                    gpu_.properties().deviceName));
  }
  drawing.fragmentShader = shaders::unsorted_transmission_frag;
  drawing.blend = blendWith(VK_BLEND_FACTOR_SRC1_COLOR, VK_BLEND_FACTOR_SRC1_ALPHA);
  return drawing;
}

MethodStats Unsorted::stats() const {
  MethodStats stats;
  stats.counted = false;
  return stats;
}

} // namespace vitrail::tool
