// A Vulkan layer that keeps pipelines (kept_pipelines.h). For one instance and one device at a time.
#include <volk.h>

#include <cstring>

#include "../layer_chain.h"
#include "kept_pipelines.h"

namespace {

PFN_vkGetInstanceProcAddr nextInstanceProc = nullptr;
PFN_vkGetDeviceProcAddr nextDeviceProc = nullptr;
VkInstance theInstance = VK_NULL_HANDLE;

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
  const VkResult result = vitrail::tests::createBehind(info, allocator, instance, nextInstanceProc);
  if (result == VK_SUCCESS) theInstance = *instance;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkDevice* device) {
  const VkResult result = vitrail::tests::createBehind(theInstance, physical, info, allocator, device, nextDeviceProc);
  if (result == VK_SUCCESS) vitrail::tests::keepPipelinesOf(*device, nextDeviceProc);
  return result;
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* allocator) {
  if (device == VK_NULL_HANDLE) return;
  vitrail::tests::destroyKeptPipelines(device); // what is wrong with them the layer above says
  reinterpret_cast<PFN_vkDestroyDevice>(nextDeviceProc(device, "vkDestroyDevice"))(device, allocator);
}

PFN_vkVoidFunction own(const char* name);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
  const PFN_vkVoidFunction function = own(name);
  return function != nullptr ? function : nextDeviceProc(device, name);
}

PFN_vkVoidFunction own(const char* name) {
  if (std::strcmp(name, "vkDestroyDevice") == 0) return reinterpret_cast<PFN_vkVoidFunction>(destroyDevice);
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
  return vitrail::tests::keepingFunction(name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkCreateInstance") == 0) return reinterpret_cast<PFN_vkVoidFunction>(createInstance);
  if (std::strcmp(name, "vkCreateDevice") == 0) return reinterpret_cast<PFN_vkVoidFunction>(createDevice);
  if (std::strcmp(name, "vkGetInstanceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getInstanceProcAddr);
  const PFN_vkVoidFunction function = own(name);
  if (function != nullptr) return function;
  return nextInstanceProc != nullptr ? nextInstanceProc(instance, name) : nullptr;
}

} // namespace

// volk's variables have the usual names of the functions that a layer exports.
extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* layer) {
  layer->loaderLayerInterfaceVersion = 2;
  layer->pfnGetInstanceProcAddr = getInstanceProcAddr;
  layer->pfnGetDeviceProcAddr = getDeviceProcAddr;
  layer->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
