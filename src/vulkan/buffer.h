// A buffer with memory of its own.
#pragma once

#include "context.h"

namespace vitrail {

struct Buffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize size = 0;      // bytes asked for
  VkDeviceSize allocated = 0; // bytes of memory behind it
  void* mapped = nullptr;     // host-visible buffers stay mapped

  // Creates the buffer in a memory type with the `required` properties, preferring one that has `preferred` too; maps
  // it where `required` has HOST_VISIBLE. `what` names it in the log ("node pool") and, after `prefix`, in debuggers.
  // `log`: of errors, where that is not the context's.
  VkResult create(const VitrailVkContext_T& context, VkDeviceSize bytes, VkBufferUsageFlags usage,
                  VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred, const char* prefix, const char* what,
                  const Log* log = nullptr);

  void destroy(const VitrailVkContext_T& context);
};

} // namespace vitrail
