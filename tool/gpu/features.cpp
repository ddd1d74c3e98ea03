#include "features.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "vk.h"

namespace vitrail::tool {

namespace {

bool blends(VkPhysicalDevice device, VkFormat format) {
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(device, format, &properties);
  return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT) != 0;
}

// The sample counts that images of a format can have for some use; 0 where there can be none.
VkSampleCountFlags imageSampleCounts(VkPhysicalDevice device, VkFormat format, VkImageUsageFlags usage) {
  VkImageFormatProperties properties{};
  const VkResult result = vkGetPhysicalDeviceImageFormatProperties(device, format, VK_IMAGE_TYPE_2D,
                                                                   VK_IMAGE_TILING_OPTIMAL, usage, 0, &properties);
  return result == VK_SUCCESS ? properties.sampleCounts : 0;
}

// The counts of samples that can be placed in the middle of the pixel.
VkSampleCountFlags middleSampleCounts(VkPhysicalDevice device) {
  if (!hasDeviceExtension(device, VK_EXT_SAMPLE_LOCATIONS_EXTENSION_NAME)) return 0;
  auto locations = vkStruct<VkPhysicalDeviceSampleLocationsPropertiesEXT>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SAMPLE_LOCATIONS_PROPERTIES_EXT);
  auto properties = vkStruct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
  properties.pNext = &locations;
  vkGetPhysicalDeviceProperties2(device, &properties);
  const float* range = locations.sampleLocationCoordinateRange;
  return range[0] <= 0.5F && range[1] >= 0.5F ? locations.sampleLocationSampleCounts : 0;
}

struct SubgroupProperties {
  bool shuffles = false;
  std::uint32_t least = 0; // threads
};

// Of compute shaders.
SubgroupProperties subgroupProperties(VkPhysicalDevice device) {
  auto properties13 =
      vkStruct<VkPhysicalDeviceVulkan13Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES);
  auto properties11 =
      vkStruct<VkPhysicalDeviceVulkan11Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES);
  properties11.pNext = &properties13;
  auto properties = vkStruct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
  properties.pNext = &properties11;
  vkGetPhysicalDeviceProperties2(device, &properties);
  const bool shuffles = (properties11.subgroupSupportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT) != 0 &&
                        (properties11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
  const std::uint32_t fixed = properties11.subgroupSize; // where it does not vary
  return {shuffles, properties13.minSubgroupSize > 0 ? properties13.minSubgroupSize : fixed};
}

// What a picture's images, and the scopes that draw into them, can have.
VkSampleCountFlags pictureSampleCounts(VkPhysicalDevice device, const VkPhysicalDeviceLimits& limits) {
  constexpr VkSampleCountFlags kUsed =
      VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_2_BIT | VK_SAMPLE_COUNT_4_BIT | VK_SAMPLE_COUNT_8_BIT;
  return kUsed & limits.framebufferColorSampleCounts & limits.framebufferDepthSampleCounts &
         limits.sampledImageColorSampleCounts & limits.sampledImageDepthSampleCounts &
         imageSampleCounts(device, VK_FORMAT_R16G16B16A16_SFLOAT,
                           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT) &
         imageSampleCounts(device, VK_FORMAT_D32_SFLOAT,
                           VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
}

} // namespace

bool hasDeviceExtension(VkPhysicalDevice device, const char* name) {
  std::uint32_t count = 0;
  check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr), "vkEnumerateDeviceExtensionProperties");
  std::vector<VkExtensionProperties> extensions(count);
  check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()),
        "vkEnumerateDeviceExtensionProperties");
  return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, name) == 0;
  });
}

GpuFeatures supportedFeatures(VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(device, &properties);
  const VkPhysicalDeviceLimits& limits = properties.limits;
  auto features12 = vkStruct<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
  auto interlock = vkStruct<VkPhysicalDeviceFragmentShaderInterlockFeaturesEXT>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADER_INTERLOCK_FEATURES_EXT);
  if (hasDeviceExtension(device, VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME)) features12.pNext = &interlock;
  auto features = vkStruct<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
  features.pNext = &features12;
  vkGetPhysicalDeviceFeatures2(device, &features);
  GpuFeatures result;
  result.bufferDeviceAddress = features12.bufferDeviceAddress == VK_TRUE;
  result.poolByAddress = result.bufferDeviceAddress && properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU;
  result.dualSourceBlending = features.features.dualSrcBlend == VK_TRUE;
  result.sampleRateShading = features.features.sampleRateShading == VK_TRUE;
  result.largePoints = features.features.largePoints == VK_TRUE;
  result.primitiveNumbers = features.features.geometryShader == VK_TRUE;
  result.independentBlending = features.features.independentBlend == VK_TRUE;
  result.floatBlending = blends(device, VK_FORMAT_R32_SFLOAT) && blends(device, VK_FORMAT_R32G32B32A32_SFLOAT);
  result.int64Atomics = features.features.shaderInt64 == VK_TRUE && features12.shaderBufferInt64Atomics == VK_TRUE;
  const SubgroupProperties subgroups = subgroupProperties(device);
  result.subgroupShuffles = subgroups.shuffles;
  result.wideSubgroups = subgroups.least >= 32;
  result.nonUniformTextures = features.features.shaderSampledImageArrayDynamicIndexing == VK_TRUE &&
                              features12.shaderSampledImageArrayNonUniformIndexing == VK_TRUE;
  result.fragmentInterlock = interlock.fragmentShaderPixelInterlock == VK_TRUE;
  if (features.features.shaderClipDistance == VK_TRUE) result.clipPlanes = limits.maxClipDistances;
  result.postDepthCoverage = hasDeviceExtension(device, VK_EXT_POST_DEPTH_COVERAGE_EXTENSION_NAME);
  result.sampleCounts = pictureSampleCounts(device, limits);
  result.middleSamples = result.sampleCounts & middleSampleCounts(device);
  const VkSampleCountFlags stencil =
      limits.framebufferStencilSampleCounts &
      imageSampleCounts(device, VK_FORMAT_D32_SFLOAT_S8_UINT,
                        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
  result.stencil = (stencil & result.sampleCounts) == result.sampleCounts;
  return result;
}

std::string sampleCountsText(VkSampleCountFlags counts) {
  std::vector<std::string> words;
  for (const std::uint32_t count : {1U, 2U, 4U, 8U}) {
    if ((counts & count) != 0) words.push_back(std::to_string(count)); // a flag's value is its count
  }
  if (words.size() < 2) return fmt::format("{}", fmt::join(words, ""));
  const std::string last = words.back();
  words.pop_back();
  return fmt::format("{} and {}", fmt::join(words, ", "), last);
}

} // namespace vitrail::tool
