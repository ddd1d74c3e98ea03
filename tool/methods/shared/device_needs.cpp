#include "device_needs.h"

#include <fmt/format.h>

namespace vitrail::tool {

namespace {

struct Need {
  std::string_view method;
  bool (*isMet)(const Gpu& gpu);
  std::string_view lack; // of a device
  std::string_view instead;
};

bool blendsFloatPairs(const Gpu& gpu) {
  VkFormatProperties format{};
  vkGetPhysicalDeviceFormatProperties(gpu.physicalDevice(), VK_FORMAT_R32G32_SFLOAT, &format);
  return (format.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT) != 0;
}

bool blendsIndependently(const Gpu& gpu) { return gpu.features().independentBlending; }
bool blendsFloats(const Gpu& gpu) { return gpu.features().floatBlending; }
bool hasInterlock(const Gpu& gpu) { return gpu.features().fragmentInterlock; }
bool hasStencil(const Gpu& gpu) { return gpu.features().stencil; }

// Several samples, all in the middle of the pixel or each in a place that is known and shaded by itself.
bool routesSamples(const Gpu& gpu) {
  const GpuFeatures& features = gpu.features();
  const bool hasPlaces = features.sampleRateShading && gpu.properties().limits.standardSampleLocations == VK_TRUE;
  return features.middleSamples > 1 || (hasPlaces && features.sampleCounts > VK_SAMPLE_COUNT_1_BIT);
}

constexpr std::string_view kNoInterlock = "has no fragment shader interlock";
constexpr std::string_view kNoStencil = "has no stencil beside a depth of 32 bits";

// The first row of a method that is not met is told.
constexpr Need kNeeds[] = {
    {"tiles", [](const Gpu& gpu) { return gpu.features().subgroupShuffles; }, "has no subgroup shuffles",
     "linked-list"},
    {"tiles",
     [](const Gpu& gpu) { return gpu.properties().limits.maxPerStageDescriptorStorageBuffers >= kTilesBuffers; },
     "lets a shader reach fewer than 29 buffers", "linked-list"},
    {"depth-peeling", [](const Gpu& gpu) { return gpu.features().primitiveNumbers; },
     "does not number triangles for fragment shaders", "reverse-depth-peeling"},
    {"dual-depth-peeling",
     [](const Gpu& gpu) {
       return blendsFloatPairs(gpu) && blendsIndependently(gpu) && gpu.properties().limits.maxColorAttachments >= 5;
     },
     "does not blend five images each in its own way, one of 32-bit floats", "depth-peeling"},
    {"stencil-routed", routesSamples, "has no several samples a pixel whose places are known and that are shaded each",
     "depth-peeling"},
    {"stencil-routed", hasStencil, kNoStencil, "depth-peeling"},
    {"weighted", blendsIndependently, "does not blend in each of several images its own way", "linked-list"},
    {"moment", [](const Gpu& gpu) { return blendsIndependently(gpu) && blendsFloats(gpu); },
     "does not blend 32-bit floats, each of several images in its own way", "linked-list"},
    {"stochastic", blendsFloats, "does not blend 32-bit floats", "linked-list"},
    {"loop-64", [](const Gpu& gpu) { return gpu.features().int64Atomics; }, "has no 64-bit atomics in buffers", "loop"},
    {"interlock", hasInterlock, kNoInterlock, "loop"},
    {"multi-layer", hasInterlock, kNoInterlock, "loop"},
};

} // namespace

std::string lackFor(const Gpu& gpu, std::string_view method) {
  for (const Need& need : kNeeds) {
    if (need.method != method || need.isMet(gpu)) continue;
    return fmt::format("{} {}, which the method {} needs: use {}", gpu.properties().deviceName, need.lack, method,
                       need.instead);
  }
  return {};
}

void requireDevice(const Gpu& gpu, std::string_view method) {
  if (const std::string lack = lackFor(gpu, method); !lack.empty()) throw GpuError(lack);
}

} // namespace vitrail::tool
