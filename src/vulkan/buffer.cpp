#include "buffer.h"

#include <cstdio>

namespace vitrail {

namespace {

constexpr std::uint32_t kNoType = ~0U;

std::uint32_t findType(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t allowed,
                       VkMemoryPropertyFlags wanted) {
  for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    if ((allowed & (1U << i)) != 0 && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  }
  return kNoType;
}

double mebibytes(VkDeviceSize bytes) { return static_cast<double>(bytes) / (1024.0 * 1024.0); }

} // namespace

VkResult Buffer::create(const VitrailVkContext_T& context, VkDeviceSize bytes, VkBufferUsageFlags usage,
                        VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred, const char* prefix,
                        const char* what, const Log* log) {
  const Log& errors = log != nullptr ? *log : context.log;
  size = bytes;
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes;
  info.usage = usage;
  VkResult result = context.vk.CreateBuffer(context.device, &info, context.allocator, &buffer);
  if (result != VK_SUCCESS) return errors.fail(result, "%s: no buffer of %.1f MiB", what, mebibytes(bytes));
  char text[128];
  std::snprintf(text, sizeof(text), "%s %s", prefix, what);
  context.name(VK_OBJECT_TYPE_BUFFER, buffer, text);

  VkMemoryRequirements needs{};
  context.vk.GetBufferMemoryRequirements(context.device, buffer, &needs);
  std::uint32_t type = findType(context.memory, needs.memoryTypeBits, required | preferred);
  if (type == kNoType) type = findType(context.memory, needs.memoryTypeBits, required);
  if (type == kNoType) return errors.fail(VK_ERROR_FEATURE_NOT_PRESENT, "%s: no memory type suits it", what);

  VkMemoryAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = type;
  VkMemoryAllocateFlagsInfo byAddress{};
  byAddress.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
  byAddress.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  if ((usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0) allocate.pNext = &byAddress;
  result = context.vk.AllocateMemory(context.device, &allocate, context.allocator, &memory);
  if (result != VK_SUCCESS) {
    return errors.fail(result, "%s: the device has no %.1f MiB of memory left", what, mebibytes(needs.size));
  }
  allocated = needs.size;
  context.name(VK_OBJECT_TYPE_DEVICE_MEMORY, memory, text);
  result = context.vk.BindBufferMemory(context.device, buffer, memory, 0);
  if (result == VK_SUCCESS && (required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0) {
    result = context.vk.MapMemory(context.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped);
  }
  if (result != VK_SUCCESS) return errors.fail(result, "%s: its memory could not be bound", what);
  return VK_SUCCESS;
}

void Buffer::destroy(const VitrailVkContext_T& context) {
  context.vk.DestroyBuffer(context.device, buffer, context.allocator);
  context.vk.FreeMemory(context.device, memory, context.allocator); // unmaps
  *this = {};
}

} // namespace vitrail
