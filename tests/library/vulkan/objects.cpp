#include "objects.h"

#include <algorithm>

namespace vitrail::tests::vulkan {

namespace {

constexpr VkAccessFlags2 kReads = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                                  VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT;

Owned<VkDeviceMemory> allocate(const Device& device, const VkMemoryRequirements& needs, Memory memory,
                               const void* next = nullptr) {
  auto info = zeroed<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
  info.pNext = next;
  info.allocationSize = needs.size;
  info.memoryTypeIndex =
      device.memoryType(needs.memoryTypeBits, memory == Memory::Device ? VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT
                                                                       : VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                                             VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  return make(device, vkAllocateMemory, vkFreeMemory, info);
}

VkImageAspectFlags aspectsOf(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D32_SFLOAT:
      return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
      return VK_IMAGE_ASPECT_COLOR_BIT;
  }
}

Owned<VkImageView> makeView(const Device& device, VkImage image, VkFormat format, VkImageAspectFlags aspects) {
  auto info = zeroed<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
  info.image = image;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = format;
  info.subresourceRange = {aspects, 0, 1, 0, 1};
  return make(device, vkCreateImageView, vkDestroyImageView, info);
}

} // namespace

Buffer::Buffer(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage, Memory memory)
    : size_(std::max<VkDeviceSize>(size, 4)) {
  auto info = zeroed<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.size = size_;
  info.usage = usage;
  buffer_ = make(device, vkCreateBuffer, vkDestroyBuffer, info);
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device.get(), buffer_.get(), &needs);
  auto flags = zeroed<VkMemoryAllocateFlagsInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO);
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  const bool addressed = (usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0;
  memory_ = allocate(device, needs, memory, addressed ? &flags : nullptr);
  check(vkBindBufferMemory(device.get(), buffer_.get(), memory_.get(), 0), "vkBindBufferMemory");
  if (memory == Memory::Host) {
    check(vkMapMemory(device.get(), memory_.get(), 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory");
  }
}

void cmdBarrier(VkCommandBuffer commands, const Access& before, const Access& after) {
  const VkMemoryBarrier2 barrier{
      VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, before.stages, before.accesses, after.stages, after.accesses};
  auto info = zeroed<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

Image::Image(const Device& device, VkExtent2D extent, VkFormat format, VkSampleCountFlagBits samples,
             VkImageUsageFlags usage)
    : aspects_(aspectsOf(format)) {
  auto info = zeroed<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {extent.width, extent.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = 1;
  info.samples = samples;
  info.usage = usage;
  image_ = make(device, vkCreateImage, vkDestroyImage, info);
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device.get(), image_.get(), &needs);
  memory_ = allocate(device, needs, Memory::Device);
  check(vkBindImageMemory(device.get(), image_.get(), memory_.get(), 0), "vkBindImageMemory");
  view_ = makeView(device, image_.get(), format, aspects_);
  sampled_ = makeView(device, image_.get(), format, aspects_ & ~VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT});
}

void Image::cmdUse(VkCommandBuffer commands, VkImageLayout layout, const Access& access) {
  if (layout == layout_ && access == access_ && (access.accesses & ~kReads) == 0) return; // reading goes on
  const VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                      nullptr,
                                      access_.stages,
                                      access_.accesses,
                                      access.stages,
                                      access.accesses,
                                      layout_,
                                      layout,
                                      VK_QUEUE_FAMILY_IGNORED,
                                      VK_QUEUE_FAMILY_IGNORED,
                                      image_.get(),
                                      {aspects_, 0, 1, 0, 1}};
  auto info = zeroed<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
  layout_ = layout;
  access_ = access;
}

void Image::forget() {
  layout_ = VK_IMAGE_LAYOUT_UNDEFINED;
  access_ = {};
}

Commands::Commands(const Device& device) : device_(device) {
  auto pool = zeroed<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
  pool.queueFamilyIndex = device.queueFamily();
  pool_ = make(device, vkCreateCommandPool, vkDestroyCommandPool, pool);
  fence_ = make(device, vkCreateFence, vkDestroyFence, zeroed<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO));
  auto info = zeroed<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
  info.commandPool = pool_.get();
  info.commandBufferCount = 1;
  check(vkAllocateCommandBuffers(device.get(), &info, &commands_), "vkAllocateCommandBuffers");
}

VkCommandBuffer Commands::begin() {
  check(vkResetCommandPool(device_.get(), pool_.get(), 0), "vkResetCommandPool");
  auto info = zeroed<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands_, &info), "vkBeginCommandBuffer");
  return commands_;
}

void Commands::execute() {
  check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
  auto submit = zeroed<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands_;
  VkFence fence = fence_.get();
  check(vkQueueSubmit(device_.queue(), 1, &submit, fence), "vkQueueSubmit");
  check(vkWaitForFences(device_.get(), 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  check(vkResetFences(device_.get(), 1, &fence), "vkResetFences");
}

void Commands::run(const std::function<void(VkCommandBuffer)>& record) {
  record(begin());
  execute();
}

} // namespace vitrail::tests::vulkan
