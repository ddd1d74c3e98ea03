// What Vulkan layers of tests have in common: how they go on to the layer or the driver behind them.
#pragma once

#include <vulkan/vk_layer.h>

namespace vitrail::tests {

// The loader's chain of layers: this one's link, which is moved on for the next.
template <typename Link, typename Info>
Link* linkOf(const Info* info, VkStructureType type) {
  auto* link = const_cast<Link*>(static_cast<const Link*>(info->pNext));
  while (link != nullptr && !(link->sType == type && link->function == VK_LAYER_LINK_INFO)) {
    link = const_cast<Link*>(static_cast<const Link*>(link->pNext));
  }
  return link;
}

// Makes an instance as what is behind makes it; `next` finds its functions.
inline VkResult createBehind(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                             VkInstance* instance, PFN_vkGetInstanceProcAddr& next) {
  auto* link = linkOf<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(next(VK_NULL_HANDLE, "vkCreateInstance"));
  return create(info, allocator, instance);
}

// The same for a device of that instance.
inline VkResult createBehind(VkInstance instance, VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                             const VkAllocationCallbacks* allocator, VkDevice* device, PFN_vkGetDeviceProcAddr& next) {
  auto* link = linkOf<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  const PFN_vkGetInstanceProcAddr instanceProc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateDevice>(instanceProc(instance, "vkCreateDevice"));
  return create(physical, info, allocator, device);
}

} // namespace vitrail::tests
