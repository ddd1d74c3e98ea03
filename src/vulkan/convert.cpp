#include "convert.h"

#include <array>
#include <utility>

namespace vitrail {

namespace {

template <class Table>
VkFlags flagsOf(std::uint32_t bits, const Table& table) {
  VkFlags flags = 0;
  for (const auto& [bit, flag] : table) {
    if ((bits & bit) != 0) flags |= flag;
  }
  return flags;
}

} // namespace

VkResult toVk(VitrailResult result) {
  switch (result) {
    case VITRAIL_SUCCESS:
      return VK_SUCCESS;
    case VITRAIL_INCOMPLETE:
      return VK_INCOMPLETE;
    case VITRAIL_ERROR_UNSUPPORTED:
      return VK_ERROR_FEATURE_NOT_PRESENT;
    case VITRAIL_ERROR_FORMAT:
      return VK_ERROR_FORMAT_NOT_SUPPORTED;
    case VITRAIL_ERROR_OUT_OF_MEMORY:
      return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    case VITRAIL_ERROR_DEVICE_LOST:
      return VK_ERROR_DEVICE_LOST;
    case VITRAIL_ERROR_INVALID:
    case VITRAIL_RESULT_MAX_ENUM:
      break;
  }
  return VK_ERROR_INITIALIZATION_FAILED;
}

VkPipelineStageFlags toVkStages(std::uint32_t stages) {
  constexpr std::array kStages = {
      std::pair<std::uint32_t, VkPipelineStageFlags>{kStageIndirect, VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT},
      std::pair<std::uint32_t, VkPipelineStageFlags>{kStageFragment, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT},
      std::pair<std::uint32_t, VkPipelineStageFlags>{kStageCompute, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT},
      std::pair<std::uint32_t, VkPipelineStageFlags>{kStageTransfer, VK_PIPELINE_STAGE_TRANSFER_BIT},
      std::pair<std::uint32_t, VkPipelineStageFlags>{kStageHost, VK_PIPELINE_STAGE_HOST_BIT}};
  return flagsOf(stages, kStages);
}

VkAccessFlags toVkAccess(std::uint32_t accesses) {
  constexpr std::array kAccesses = {
      std::pair<std::uint32_t, VkAccessFlags>{kAccessIndirectRead, VK_ACCESS_INDIRECT_COMMAND_READ_BIT},
      std::pair<std::uint32_t, VkAccessFlags>{kAccessUniformRead, VK_ACCESS_UNIFORM_READ_BIT},
      std::pair<std::uint32_t, VkAccessFlags>{kAccessShaderRead, VK_ACCESS_SHADER_READ_BIT},
      std::pair<std::uint32_t, VkAccessFlags>{kAccessShaderWrite, VK_ACCESS_SHADER_WRITE_BIT},
      std::pair<std::uint32_t, VkAccessFlags>{kAccessTransferRead, VK_ACCESS_TRANSFER_READ_BIT},
      std::pair<std::uint32_t, VkAccessFlags>{kAccessTransferWrite, VK_ACCESS_TRANSFER_WRITE_BIT},
      std::pair<std::uint32_t, VkAccessFlags>{kAccessHostRead, VK_ACCESS_HOST_READ_BIT}};
  return flagsOf(accesses, kAccesses);
}

} // namespace vitrail
