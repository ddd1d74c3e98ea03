// What devices differ in: the optional features that the tool uses, and the sample counts.
#pragma once

#include <cstdint>
#include <string>

#include <volk.h>

namespace vitrail::tool {

// What the tool uses where a device has it, and does without where it has not.
struct GpuFeatures {
  bool bufferDeviceAddress = false;
  // Whether node pools are reached by their address, which has no limit of size. Not on CPU devices, which reach a
  // binding faster (docs/performance.md).
  bool poolByAddress = false;
  bool dualSourceBlending = false;
  bool sampleRateShading = false;
  bool largePoints = false;             // points of more than a pixel
  bool primitiveNumbers = false;        // gl_PrimitiveID in fragment shaders, which comes with geometry shaders
  bool independentBlending = false;     // colour attachments differ in how they blend
  bool floatBlending = false;           // 32-bit float colour attachments blend
  bool int64Atomics = false;            // minima of 64-bit integers in buffers
  bool nonUniformTextures = false;      // threads side by side choose different textures of an array
  bool subgroupShuffles = false;        // threads of a subgroup of compute shaders hand each other words
  bool wideSubgroups = false;           // whose subgroups have 32 threads or more
  bool fragmentInterlock = false;       // VK_EXT_fragment_shader_interlock, of pixels
  bool postDepthCoverage = false;       // VK_EXT_post_depth_coverage
  VkSampleCountFlags middleSamples = 0; // counts of samples that can all be in the middle (VK_EXT_sample_locations)
  std::uint32_t clipPlanes = 0;         // that cut surfaces (shaderClipDistance); 0: none can
  bool stencil = false;                 // images of D32_SFLOAT_S8_UINT
  VkSampleCountFlags sampleCounts = VK_SAMPLE_COUNT_1_BIT; // of a picture's images
};

// Whether it has an extension of that name.
bool hasDeviceExtension(VkPhysicalDevice device, const char* name);

GpuFeatures supportedFeatures(VkPhysicalDevice device);

// A sample count as a flag, whose value is the count.
inline VkSampleCountFlagBits flagOf(std::uint32_t samples) { return static_cast<VkSampleCountFlagBits>(samples); }

// Sample counts in words: "1 and 4", "1, 2, 4 and 8".
std::string sampleCountsText(VkSampleCountFlags counts);

} // namespace vitrail::tool
