// A Vulkan layer whose devices are lost as soon as the file that VITRAIL_TEST_LOSE names is there: each such device
// then refuses all work, and the file is taken away, so that the next device works.
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>

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

// The loader's chain of layers: this one's link, which is moved on for the next.
template <typename Link, typename Info>
Link* linkOf(const Info* info, VkStructureType type) {
  auto* link = const_cast<Link*>(static_cast<const Link*>(info->pNext));
  while (link != nullptr && !(link->sType == type && link->function == VK_LAYER_LINK_INFO)) {
    link = const_cast<Link*>(static_cast<const Link*>(link->pNext));
  }
  return link;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
  auto* link = linkOf<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  nextInstanceProc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(nextInstanceProc(VK_NULL_HANDLE, "vkCreateInstance"));
  const VkResult result = create(info, allocator, instance);
  if (result == VK_SUCCESS) theInstance = *instance;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkDevice* device) {
  auto* link = linkOf<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  const PFN_vkGetInstanceProcAddr instanceProc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  DeviceState state;
  state.next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateDevice>(instanceProc(theInstance, "vkCreateDevice"));
  const VkResult result = create(physical, info, allocator, device);
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
