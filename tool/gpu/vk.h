// Small helpers around Vulkan calls: typed structs, results that become GpuError, debug names.
#pragma once

#include <cstdint>
#include <string>

#include "device.h"

namespace vitrail::tool {

// A zeroed Vulkan struct of its type.
template <typename Struct>
Struct vkStruct(VkStructureType type) {
  Struct value{};
  value.sType = type;
  return value;
}

// The name of a result, as in "VK_ERROR_DEVICE_LOST".
std::string resultName(VkResult result);

// Throws GpuError where `result` is an error, DeviceLost where it says so. `call` names what was asked for, as in
// "vkCreateBuffer (vertices)". Exhausted memory and a lost device are put in words that say what to do.
void check(VkResult result, const std::string& call);

// Names an object for validation messages and debuggers. Does nothing where the instance has no debug utilities.
void setDebugName(VkDevice device, VkObjectType type, std::uint64_t handle, const std::string& name);

// The same for any handle: dispatchable ones are pointers and the others are too on 64-bit machines.
template <typename Handle>
void setDebugName(VkDevice device, VkObjectType type, Handle handle, const std::string& name) {
  setDebugName(device, type, reinterpret_cast<std::uint64_t>(handle), name);
}

} // namespace vitrail::tool
