#include "library_context.h"

#include "library_log.h"

namespace vitrail::tool {

namespace {

std::uint32_t libraryFeatures(const GpuFeatures& features) {
  std::uint32_t bits = 0;
  if (features.poolByAddress) bits |= VITRAIL_VK_FEATURE_BUFFER_DEVICE_ADDRESS;
  if (features.dualSourceBlending) bits |= VITRAIL_VK_FEATURE_DUAL_SRC_BLEND;
  if (features.sampleRateShading) bits |= VITRAIL_VK_FEATURE_SAMPLE_RATE_SHADING;
  return bits;
}

} // namespace

VkResult makeLibraryContext(Gpu& gpu, std::string& reason, vulkan::Context& context) {
  VitrailVkContextDesc desc{};
  desc.instance = gpu.instance();
  desc.physicalDevice = gpu.physicalDevice();
  desc.device = gpu.device();
  desc.getInstanceProcAddr = vkGetInstanceProcAddr;
  desc.features = libraryFeatures(gpu.features());
  desc.log = rememberError;
  desc.logUser = &reason;
  return vulkan::Context::create(desc, context);
}

} // namespace vitrail::tool
