// Creation and destruction of a context: checks the device, builds the layouts and the resolve pipelines.
#include "context.h"

#include <algorithm>
#include <memory>
#include <new>

#include "core/pool.h"
#include "shaders/resolve_long_rgba16f.h"
#include "shaders/resolve_long_rgba32f.h"
#include "shaders/resolve_rgba16f.h"
#include "shaders/resolve_rgba32f.h"

namespace vitrail {

namespace {

// The SPIR-V of the resolve, in the order of kColorFormats.
struct Code {
  const std::uint32_t* words;
  std::size_t bytes;
};
struct ResolveCode {
  Code shortLists;
  Code longLists;
};
template <std::size_t kShort, std::size_t kLong>
constexpr ResolveCode resolveCode(const std::uint32_t (&shortLists)[kShort], const std::uint32_t (&longLists)[kLong]) {
  return {{shortLists, sizeof(shortLists)}, {longLists, sizeof(longLists)}};
}
constexpr std::array<ResolveCode, kColorFormats.size()> kResolveCode = {
    resolveCode(shaders::resolve_rgba16f, shaders::resolve_long_rgba16f),
    resolveCode(shaders::resolve_rgba32f, shaders::resolve_long_rgba32f),
};

VkResult checkDevice(VitrailContext_T& context) {
  VkPhysicalDeviceMaintenance3Properties maintenance3{};
  maintenance3.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
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
  VkPhysicalDeviceFeatures features{};
  context.vk.GetPhysicalDeviceFeatures(context.physicalDevice, &features);
  if (features.fragmentStoresAndAtomics == VK_FALSE) {
    return context.log.fail(VK_ERROR_FEATURE_NOT_PRESENT, "%s lacks fragmentStoresAndAtomics, which collects fragments",
                            device.deviceName);
  }
  context.vk.GetPhysicalDeviceMemoryProperties(context.physicalDevice, &context.memory);
  context.limits.storageBufferRange = device.limits.maxStorageBufferRange;
  context.limits.storageBufferAlignment = std::max<VkDeviceSize>(1, device.limits.minStorageBufferOffsetAlignment);
  context.limits.allocationSize = maintenance3.maxMemoryAllocationSize;
  return VK_SUCCESS;
}

VkResult createSetLayouts(VitrailContext_T& context) {
  std::array<VkDescriptorSetLayoutBinding, kBindingCount> bindings{};
  for (std::uint32_t i = 0; i < kBindingCount; ++i) {
    bindings[i].binding = i;
    bindings[i].descriptorType =
        i == kParametersBinding ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    bindings[i].descriptorCount = 1;
    bindings[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    if (i != kLongListsBinding) bindings[i].stageFlags |= VK_SHADER_STAGE_FRAGMENT_BIT;
  }
  VkDescriptorSetLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  info.bindingCount = kBindingCount;
  info.pBindings = bindings.data();
  VkResult result = context.vk.CreateDescriptorSetLayout(context.device, &info, context.allocator, &context.setLayout);
  if (result != VK_SUCCESS) return result;
  context.name(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, context.setLayout, "vitrail target set layout");

  VkDescriptorSetLayoutBinding color{};
  color.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  color.descriptorCount = 1;
  color.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
  info.bindingCount = 1;
  info.pBindings = &color;
  result = context.vk.CreateDescriptorSetLayout(context.device, &info, context.allocator, &context.colorSetLayout);
  if (result != VK_SUCCESS) return result;
  context.name(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, context.colorSetLayout, "vitrail colour set layout");
  return VK_SUCCESS;
}

VkResult createResolvePipeline(const VitrailContext_T& context, const Code& code, const char* name,
                               VkPipeline* pipeline) {
  VkShaderModuleCreateInfo moduleInfo{};
  moduleInfo.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  moduleInfo.codeSize = code.bytes;
  moduleInfo.pCode = code.words;
  VkShaderModule shader = VK_NULL_HANDLE;
  VkResult result = context.vk.CreateShaderModule(context.device, &moduleInfo, context.allocator, &shader);
  if (result != VK_SUCCESS) return result;
  context.name(VK_OBJECT_TYPE_SHADER_MODULE, shader, name);

  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = shader;
  info.stage.pName = "main";
  info.layout = context.resolveLayout;
  result = context.vk.CreateComputePipelines(context.device, context.cache, 1, &info, context.allocator, pipeline);
  context.vk.DestroyShaderModule(context.device, shader, context.allocator);
  if (result == VK_SUCCESS) context.name(VK_OBJECT_TYPE_PIPELINE, *pipeline, name);
  return result;
}

VkResult createResolveLayout(VitrailContext_T& context) {
  const std::array<VkDescriptorSetLayout, 2> sets = {context.setLayout, context.colorSetLayout};
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

VkResult build(VitrailContext_T& context) {
  VkResult result = checkDevice(context);
  if (result != VK_SUCCESS) return result;
  result = createSetLayouts(context);
  if (result == VK_SUCCESS) result = createResolveLayout(context);
  if (result != VK_SUCCESS) return context.log.fail(result, "the descriptor set layouts could not be created");
  return VK_SUCCESS;
}

} // namespace

std::size_t colorFormatIndex(VkFormat format) {
  return static_cast<std::size_t>(std::find(kColorFormats.begin(), kColorFormats.end(), format) -
                                  kColorFormats.begin());
}

} // namespace vitrail

void VitrailContext_T::name(VkObjectType type, std::uint64_t handle, const char* text) const {
  if (vk.SetDebugUtilsObjectNameEXT == nullptr) return;
  VkDebugUtilsObjectNameInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
  info.objectType = type;
  info.objectHandle = handle;
  info.pObjectName = text;
  vk.SetDebugUtilsObjectNameEXT(device, &info); // a name that cannot be kept changes nothing
}

VkResult VitrailContext_T::resolvePipelines(std::size_t format, vitrail::ResolvePipelines* made) {
  const std::lock_guard lock(pipelines);
  vitrail::ResolvePipelines& kept = resolve[format];
  if (kept.longLists == VK_NULL_HANDLE) {
    VkFormatProperties properties{};
    vk.GetPhysicalDeviceFormatProperties(physicalDevice, vitrail::kColorFormats[format], &properties);
    if ((properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) == 0) {
      return log.fail(VK_ERROR_FORMAT_NOT_SUPPORTED, "colorFormat %d: this device cannot use it as storage image",
                      vitrail::kColorFormats[format]);
    }
    const vitrail::ResolveCode& code = vitrail::kResolveCode[format];
    VkResult result = VK_SUCCESS;
    if (kept.shortLists == VK_NULL_HANDLE) {
      result = vitrail::createResolvePipeline(*this, code.shortLists, "vitrail resolve", &kept.shortLists);
    }
    if (result == VK_SUCCESS) {
      result = vitrail::createResolvePipeline(*this, code.longLists, "vitrail resolve long", &kept.longLists);
    }
    if (result != VK_SUCCESS) return log.fail(result, "the resolve pipelines could not be created");
  }
  *made = kept;
  return VK_SUCCESS;
}

extern "C" VkResult vitrailCreateContext(const VitrailContextDesc* desc, VitrailContext* context) {
  if (context == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  *context = nullptr;
  if (desc == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  const vitrail::Log log{desc->log, desc->logUser};
  if (desc->instance == VK_NULL_HANDLE || desc->physicalDevice == VK_NULL_HANDLE || desc->device == VK_NULL_HANDLE ||
      desc->getInstanceProcAddr == nullptr) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "VitrailContextDesc needs instance, physicalDevice, device and getInstanceProcAddr");
  }
  std::unique_ptr<VitrailContext_T> made(new (std::nothrow) VitrailContext_T);
  if (!made) return log.fail(VK_ERROR_OUT_OF_HOST_MEMORY, "no memory for a context");
  made->log = log;
  made->physicalDevice = desc->physicalDevice;
  made->device = desc->device;
  made->allocator = desc->allocator;
  made->cache = desc->cache;
  if (const char* missing = made->vk.load(desc->instance, desc->device, desc->getInstanceProcAddr)) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED,
                    "the driver has no %s: create instance and device for Vulkan 1.2 or later", missing);
  }
  const VkResult result = vitrail::build(*made);
  if (result != VK_SUCCESS) {
    vitrailDestroyContext(made.release());
    return result;
  }
  *context = made.release();
  return VK_SUCCESS;
}

extern "C" void vitrailDestroyContext(VitrailContext context) {
  if (context == nullptr) return;
  const std::unique_ptr<VitrailContext_T> owned(context);
  const vitrail::Dispatch& vk = context->vk;
  for (const vitrail::ResolvePipelines& pipelines : context->resolve) {
    vk.DestroyPipeline(context->device, pipelines.shortLists, context->allocator);
    vk.DestroyPipeline(context->device, pipelines.longLists, context->allocator);
  }
  vk.DestroyPipelineLayout(context->device, context->resolveLayout, context->allocator);
  vk.DestroyDescriptorSetLayout(context->device, context->colorSetLayout, context->allocator);
  vk.DestroyDescriptorSetLayout(context->device, context->setLayout, context->allocator);
}

extern "C" VkDescriptorSetLayout vitrailDescriptorSetLayout(VitrailContext context) { return context->setLayout; }

extern "C" uint32_t vitrailMaxNodeCapacity(VitrailContext context, VitrailNodeFormat /*only one format so far*/) {
  VkDeviceSize heap = 0;
  for (std::uint32_t i = 0; i < context->memory.memoryHeapCount; ++i) {
    if ((context->memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) {
      heap = std::max(heap, context->memory.memoryHeaps[i].size);
    }
  }
  return vitrail::nodesThatFit(std::min({context->limits.storageBufferRange, context->limits.allocationSize, heap}));
}

extern "C" VkDeviceSize vitrailNodePoolSize(VitrailNodeFormat /*only one format so far*/, uint32_t nodeCapacity) {
  return vitrail::nodePoolBytes(nodeCapacity);
}
