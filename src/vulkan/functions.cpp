#include "functions.h"

namespace vitrail {

const char* Functions::load(VkInstance instance, VkDevice device, PFN_vkGetInstanceProcAddr getInstanceProcAddr) {
#define VITRAIL_LOAD_INSTANCE(name)                                                   \
  (name) = reinterpret_cast<PFN_vk##name>(getInstanceProcAddr(instance, "vk" #name)); \
  if ((name) == nullptr) return "vk" #name;
#define VITRAIL_LOAD_DEVICE(name)                                                 \
  (name) = reinterpret_cast<PFN_vk##name>(GetDeviceProcAddr(device, "vk" #name)); \
  if ((name) == nullptr) return "vk" #name;
  VITRAIL_INSTANCE_FUNCTIONS(VITRAIL_LOAD_INSTANCE)
  VITRAIL_DEVICE_FUNCTIONS(VITRAIL_LOAD_DEVICE)
#undef VITRAIL_LOAD_INSTANCE
#undef VITRAIL_LOAD_DEVICE
  // Optional. It belongs to an instance extension, so the loader answers null where the host has not enabled it.
  SetDebugUtilsObjectNameEXT =
      reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(getInstanceProcAddr(instance, "vkSetDebugUtilsObjectNameEXT"));
  return nullptr;
}

} // namespace vitrail
