// Creation and destruction of a context: checks the device, builds the layouts.
#include "context.h"

#include <algorithm>
#include <memory>
#include <new>

#include "check.h"
#include "convert.h"
#include "core/target_rules.h"
#include "vitrail/bindings.h"

namespace vitrail {

namespace {

// The host says that its device was created with these; a physical device without them tells that it was not.
VkResult checkFeatures(const VitrailVkContext_T& context, const char* deviceName) {
  VkPhysicalDeviceVulkan12Features features12{};
  features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  VkPhysicalDeviceFeatures2 features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  features.pNext = &features12;
  context.vk.GetPhysicalDeviceFeatures2(context.physicalDevice, &features);
  const VkPhysicalDeviceFeatures& core = features.features;
  const auto lacks = [&](const char* feature, const char* use) {
    return context.log.fail(VK_ERROR_FEATURE_NOT_PRESENT, "%s lacks %s, which %s", deviceName, feature, use);
  };
  if (core.fragmentStoresAndAtomics == VK_FALSE) return lacks("fragmentStoresAndAtomics", "collects fragments");
  if (context.has(VITRAIL_VK_FEATURE_BUFFER_DEVICE_ADDRESS) && features12.bufferDeviceAddress == VK_FALSE) {
    return lacks("bufferDeviceAddress", "VitrailVkContextDesc::features names");
  }
  if (context.has(VITRAIL_VK_FEATURE_DUAL_SRC_BLEND) && core.dualSrcBlend == VK_FALSE) {
    return lacks("dualSrcBlend", "VitrailVkContextDesc::features names");
  }
  if (context.has(VITRAIL_VK_FEATURE_SAMPLE_RATE_SHADING) && core.sampleRateShading == VK_FALSE) {
    return lacks("sampleRateShading", "VitrailVkContextDesc::features names");
  }
  return VK_SUCCESS;
}

void readLimits(VitrailVkContext_T& context, const VkPhysicalDeviceProperties& device, VkDeviceSize allocationSize) {
  const VkPhysicalDeviceLimits& limits = device.limits;
  DeviceLimits& kept = context.limits;
  constexpr VkDeviceSize kLeastAlignment = 256; // of the parts that are cleared and copied, on every device
  kept.storageBufferRange = limits.maxStorageBufferRange;
  kept.allocationSize = allocationSize;
  kept.alignment =
      std::max({limits.minStorageBufferOffsetAlignment, limits.minUniformBufferOffsetAlignment, kLeastAlignment});
  kept.sampleCounts = limits.framebufferColorSampleCounts & limits.framebufferDepthSampleCounts &
                      limits.sampledImageColorSampleCounts & limits.sampledImageDepthSampleCounts;
  kept.isCpu = device.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  kept.networks = !kept.isCpu;
  kept.oneBlend = kept.isCpu;
#ifdef VITRAIL_TEST_USE_NETWORKS // so that a CPU device tests what GPUs run
  kept.networks = true;
  kept.oneBlend = false;
#endif
  kept.poolByAddress = context.has(VITRAIL_VK_FEATURE_BUFFER_DEVICE_ADDRESS);
  kept.dualSourceBlending = context.has(VITRAIL_VK_FEATURE_DUAL_SRC_BLEND);
  kept.sampleShading = context.has(VITRAIL_VK_FEATURE_SAMPLE_RATE_SHADING);
  // NVIDIA's GH100 (H100, H200 and their like), of which 2 of 66 texture processing clusters draw. Vulkan does not tell
  // such things of a device.
  constexpr std::uint32_t kNvidia = 0x10de;
  kept.fewFragmentCores = device.vendorID == kNvidia && device.deviceID >> 8U == 0x23;
#ifdef VITRAIL_TEST_FEW_FRAGMENT_CORES // so that any device tests what such a GPU takes by default
  kept.fewFragmentCores = true;
#endif
  context.vk.GetPhysicalDeviceMemoryProperties(context.physicalDevice, &context.memory);
  for (std::uint32_t i = 0; i < context.memory.memoryHeapCount; ++i) {
    const VkMemoryHeap& heap = context.memory.memoryHeaps[i];
    if ((heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) kept.heapSize = std::max(kept.heapSize, heap.size);
  }
}

// What the kernels ask for in which groups of invocations resolve a list.
bool exchangesInGroups(const VkPhysicalDeviceSubgroupProperties& subgroups) {
  return (subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 &&
         (subgroups.supportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT) != 0 && subgroups.subgroupSize >= 8;
}

VkResult checkDevice(VitrailVkContext_T& context) {
  VkPhysicalDeviceSubgroupProperties subgroups{};
  subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
  VkPhysicalDeviceMaintenance3Properties maintenance3{};
  maintenance3.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
  maintenance3.pNext = &subgroups;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &maintenance3;
  context.vk.GetPhysicalDeviceProperties2(context.physicalDevice, &properties);
  const VkPhysicalDeviceProperties& device = properties.properties;
  if (device.apiVersion < VK_API_VERSION_1_2) {
    return context.log.fail(VK_ERROR_FEATURE_NOT_PRESENT, "%s offers Vulkan %u.%u; Vitrail needs 1.2",
                            device.deviceName, VK_API_VERSION_MAJOR(device.apiVersion),
                            VK_API_VERSION_MINOR(device.apiVersion));
  }
  constexpr std::uint32_t kStorageBuffers = VITRAIL_BINDINGS - 1; // that a kernel binds; Vulkan asks for 4 of a device
  if (device.limits.maxPerStageDescriptorStorageBuffers < kStorageBuffers) {
    return context.log.fail(VK_ERROR_FEATURE_NOT_PRESENT, "%s binds %u storage buffers to a shader; Vitrail needs %u",
                            device.deviceName, device.limits.maxPerStageDescriptorStorageBuffers, kStorageBuffers);
  }
  readLimits(context, device, maintenance3.maxMemoryAllocationSize);
  context.limits.exchangesInGroups = exchangesInGroups(subgroups);
  return checkFeatures(context, device.deviceName);
}

VkResult createSetLayout(const VitrailVkContext_T& context, std::span<const VkDescriptorSetLayoutBinding> bindings,
                         const char* name, VkDescriptorSetLayout* layout) {
  VkDescriptorSetLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  const VkResult result = context.vk.CreateDescriptorSetLayout(context.device, &info, context.allocator, layout);
  if (result == VK_SUCCESS) context.name(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, *layout, name);
  return result;
}

VkResult createSetLayouts(VitrailVkContext_T& context) {
  std::array<VkDescriptorSetLayoutBinding, VITRAIL_BINDINGS> buffers{};
  for (std::uint32_t i = 0; i < VITRAIL_BINDINGS; ++i) {
    buffers[i].binding = i;
    buffers[i].descriptorType =
        i == VITRAIL_BINDING_PARAMETERS ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    buffers[i].descriptorCount = 1;
    buffers[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    if (i < VITRAIL_BINDING_MEDIUM_LISTS) buffers[i].stageFlags |= VK_SHADER_STAGE_FRAGMENT_BIT;
  }
  VkResult result = createSetLayout(context, buffers, "vitrail target set layout", &context.setLayout);
  if (result != VK_SUCCESS) return result;

  std::array<VkDescriptorSetLayoutBinding, VITRAIL_VIEW_BINDINGS> images{};
  for (std::uint32_t i = 0; i < VITRAIL_VIEW_BINDINGS; ++i) {
    images[i].binding = i;
    images[i].descriptorType =
        i == VITRAIL_VIEW_BINDING_COLOR ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    images[i].descriptorCount = 1;
    images[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    if (i != VITRAIL_VIEW_BINDING_COLOR) images[i].stageFlags |= VK_SHADER_STAGE_FRAGMENT_BIT;
  }
  return createSetLayout(context, images, "vitrail view set layout", &context.viewSetLayout);
}

VkResult createResolveLayout(VitrailVkContext_T& context) {
  const std::array<VkDescriptorSetLayout, 2> sets = {context.setLayout, context.viewSetLayout};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
  info.pSetLayouts = sets.data();
  const VkResult result =
      context.vk.CreatePipelineLayout(context.device, &info, context.allocator, &context.resolveLayout);
  if (result != VK_SUCCESS) return result;
  context.name(VK_OBJECT_TYPE_PIPELINE_LAYOUT, context.resolveLayout, "vitrail resolve layout");
  return VK_SUCCESS;
}

VkResult build(VitrailVkContext_T& context) {
  VkResult result = checkDevice(context);
  if (result != VK_SUCCESS) return result;
  result = createSetLayouts(context);
  if (result == VK_SUCCESS) result = createResolveLayout(context);
  if (result != VK_SUCCESS) return context.log.fail(result, "the descriptor set layouts could not be created");
  return VK_SUCCESS;
}

} // namespace

} // namespace vitrail

void VitrailVkContext_T::name(VkObjectType type, std::uint64_t handle, const char* text) const {
  if (vk.SetDebugUtilsObjectNameEXT == nullptr) return;
  VkDebugUtilsObjectNameInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
  info.objectType = type;
  info.objectHandle = handle;
  info.pObjectName = text;
  vk.SetDebugUtilsObjectNameEXT(device, &info); // a name that cannot be kept changes nothing
}

void vitrail::releaseContext(VitrailVkContext context) {
  if (context->owners.fetch_sub(1) > 1) return;
  const std::unique_ptr<VitrailVkContext_T> owned(context);
  const Functions& vk = context->vk;
  for (const auto& [key, pipeline] : context->pipelines) {
    vk.DestroyPipeline(context->device, pipeline, context->allocator);
  }
  vk.DestroyPipelineLayout(context->device, context->resolveLayout, context->allocator);
  vk.DestroyDescriptorSetLayout(context->device, context->viewSetLayout, context->allocator);
  vk.DestroyDescriptorSetLayout(context->device, context->setLayout, context->allocator);
}

extern "C" VkResult vitrailVkCreateContext(const VitrailVkContextDesc* desc, VitrailVkContext* context) {
  using namespace vitrail;
  if (context != nullptr) *context = nullptr;
  const Log log = desc != nullptr ? Log{desc->log, desc->logUser} : Log{};
  if (desc == nullptr || context == nullptr) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "vitrailVkCreateContext: an argument is null");
  }
  if (checkNext(log, desc->next, "VitrailVkContextDesc") != VK_SUCCESS) return VK_ERROR_INITIALIZATION_FAILED;
  if (desc->instance == VK_NULL_HANDLE || desc->physicalDevice == VK_NULL_HANDLE || desc->device == VK_NULL_HANDLE ||
      desc->getInstanceProcAddr == nullptr) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "VitrailVkContextDesc needs instance, physicalDevice, device and getInstanceProcAddr");
  }
  constexpr std::uint32_t kKnown = VITRAIL_VK_FEATURE_BUFFER_DEVICE_ADDRESS | VITRAIL_VK_FEATURE_DUAL_SRC_BLEND |
                                   VITRAIL_VK_FEATURE_SAMPLE_RATE_SHADING;
  if ((desc->features & ~kKnown) != 0) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "features 0x%x: 0x%x is none of VitrailVkFeatureBits",
                    desc->features, desc->features & ~kKnown);
  }
  std::unique_ptr<VitrailVkContext_T> made(new (std::nothrow) VitrailVkContext_T);
  if (!made) return log.fail(VK_ERROR_OUT_OF_HOST_MEMORY, "no memory for a context");
  made->log = log;
  made->physicalDevice = desc->physicalDevice;
  made->device = desc->device;
  made->features = desc->features;
  made->allocator = desc->allocator;
  made->cache = desc->cache;
  if (const char* missing = made->vk.load(desc->instance, desc->device, desc->getInstanceProcAddr)) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "the driver has no %s: create instance and device for Vulkan 1.2 or later", missing);
  }
  const VkResult result = build(*made);
  if (result != VK_SUCCESS) {
    releaseContext(made.release());
    return result;
  }
  *context = made.release();
  return VK_SUCCESS;
}

extern "C" void vitrailVkDestroyContext(VitrailVkContext context) {
  if (context == nullptr) return;
  const std::uint32_t targets = context->owners.load() - 1;
  if (targets > 0) {
    context->log.error(
        "vitrailVkDestroyContext: targets are left (%u): destroy them first; the context is freed with the "
        "last of them, which its device must outlive",
        targets);
  }
  context->destroyed = true;
  vitrail::releaseContext(context);
}

extern "C" VkDescriptorSetLayout vitrailVkDescriptorSetLayout(VitrailVkContext context) {
  return context != nullptr ? context->setLayout : VK_NULL_HANDLE;
}

extern "C" uint32_t vitrailVkMaxNodeCapacity(VitrailVkContext context, VitrailNodeFormat format,
                                             VkSampleCountFlagBits samples) {
  if (context == nullptr) return 0;
  return vitrail::maxNodeCapacity(context->limits, format, samples, false);
}

extern "C" VkResult vitrailVkTileLimits(VitrailVkContext context, VitrailNodeFormat format,
                                        VkSampleCountFlagBits samples, VitrailTileLimits* limits) {
  using namespace vitrail;
  if (limits != nullptr) clearKeepingNext(*limits);
  if (context == nullptr || limits == nullptr) return nullArgument(context, "vitrailVkTileLimits");
  return toVk(tileLimits(context->limits, context->log, format, samples, *limits));
}
