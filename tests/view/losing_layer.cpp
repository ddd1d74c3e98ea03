// A Vulkan layer whose devices are lost as soon as the file that VITRAIL_TEST_LOSE names is there: each such device
// then refuses all work, and the file is taken away, so that the next device works.
#include <vulkan/vulkan.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>

#include "../layer_chain.h"

namespace {

PFN_vkGetInstanceProcAddr nextInstanceProc = nullptr;
VkInstance theInstance = VK_NULL_HANDLE;

struct DeviceState {
  PFN_vkGetDeviceProcAddr next = nullptr;
  PFN_vkQueueSubmit2 submit = nullptr;
  PFN_vkDestroyDevice destroy = nullptr;
  bool lost = false;
};
std::mutex mutex;
std::map<void*, DeviceState> devices; // by dispatch table, which a device's queues have too

void* keyOf(const void* handle) {
  void* key = nullptr;
  std::memcpy(&key, handle, sizeof(key));
  return key;
}

VKAPI_ATTR VkResult VKAPI_CALL queueSubmit2(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* infos,
                                            VkFence fence) {
  DeviceState state;
  {
    const std::lock_guard lock(mutex);
    DeviceState& kept = devices.at(keyOf(queue));
    const char* file = std::getenv("VITRAIL_TEST_LOSE");
    if (file != nullptr && std::remove(file) == 0) kept.lost = true;
    state = kept;
  }
  return state.lost ? VK_ERROR_DEVICE_LOST : state.submit(queue, count, infos, fence);
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* allocator) {
  if (device == VK_NULL_HANDLE) return;
  DeviceState state;
  {
    const std::lock_guard lock(mutex);
    state = devices.at(keyOf(device));
    devices.erase(keyOf(device));
  }
  state.destroy(device, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
  const VkResult result = vitrail::tests::createBehind(info, allocator, instance, nextInstanceProc);
  if (result == VK_SUCCESS) theInstance = *instance;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkDevice* device) {
  DeviceState state;
  const VkResult result = vitrail::tests::createBehind(theInstance, physical, info, allocator, device, state.next);
  if (result != VK_SUCCESS) return result;
  state.submit = reinterpret_cast<PFN_vkQueueSubmit2>(state.next(*device, "vkQueueSubmit2"));
  state.destroy = reinterpret_cast<PFN_vkDestroyDevice>(state.next(*device, "vkDestroyDevice"));
  const std::lock_guard lock(mutex);
  devices[keyOf(*device)] = state;
  return result;
}

} // namespace

extern "C" {

__attribute__((visibility("default"))) VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetDeviceProcAddr(VkDevice device,
                                                                                                    const char* name) {
  if (std::strcmp(name, "vkQueueSubmit2") == 0) return reinterpret_cast<PFN_vkVoidFunction>(queueSubmit2);
  if (std::strcmp(name, "vkDestroyDevice") == 0) return reinterpret_cast<PFN_vkVoidFunction>(destroyDevice);
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(vkGetDeviceProcAddr);
  const std::lock_guard lock(mutex);
  return devices.at(keyOf(device)).next(device, name);
}

__attribute__((visibility("default"))) VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL
vkGetInstanceProcAddr(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkCreateInstance") == 0) return reinterpret_cast<PFN_vkVoidFunction>(createInstance);
  if (std::strcmp(name, "vkCreateDevice") == 0) return reinterpret_cast<PFN_vkVoidFunction>(createDevice);
  if (std::strcmp(name, "vkGetInstanceProcAddr") == 0) {
    return reinterpret_cast<PFN_vkVoidFunction>(vkGetInstanceProcAddr);
  }
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(vkGetDeviceProcAddr);
  if (std::strcmp(name, "vkQueueSubmit2") == 0) return reinterpret_cast<PFN_vkVoidFunction>(queueSubmit2);
  if (std::strcmp(name, "vkDestroyDevice") == 0) return reinterpret_cast<PFN_vkVoidFunction>(destroyDevice);
  return nextInstanceProc != nullptr ? nextInstanceProc(instance, name) : nullptr;
}
}
