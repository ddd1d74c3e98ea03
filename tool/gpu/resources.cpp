#include "resources.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "vk.h"

namespace vitrail::tool {

namespace {

// The properties a kind of memory is looked for with, best first.
std::span<const VkMemoryPropertyFlags> wishes(MemoryKind kind) {
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  static constexpr std::array<VkMemoryPropertyFlags, 2> kDeviceWishes{VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
  static constexpr std::array<VkMemoryPropertyFlags, 1> kUploadWishes{kHost};
  static constexpr std::array<VkMemoryPropertyFlags, 2> kReadbackWishes{kHost | VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
                                                                        kHost};
  switch (kind) {
    case MemoryKind::Upload:
      return kUploadWishes;
    case MemoryKind::Readback:
      return kReadbackWishes;
    default:
      return kDeviceWishes;
  }
}

std::uint32_t memoryType(const Gpu& gpu, std::uint32_t allowed, MemoryKind kind, const std::string& name) {
  const VkPhysicalDeviceMemoryProperties& memory = gpu.memoryProperties();
  for (const VkMemoryPropertyFlags wish : wishes(kind)) {
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
      if ((allowed >> i & 1U) != 0 && (memory.memoryTypes[i].propertyFlags & wish) == wish) return i;
    }
  }
  throw GpuError(fmt::format("{} has no memory that fits the {}", gpu.properties().deviceName, name));
}

} // namespace

Allocation::Allocation(Gpu& gpu, const VkMemoryRequirements& requirements, MemoryKind kind, const std::string& name,
                       bool addressed)
    : size_(requirements.size) {
  if (size_ > gpu.maxAllocation()) {
    throw GpuError(fmt::format("the {} take{} {} MiB; {} can allocate at most {} MiB at once: use a smaller {}", name,
                               name.ends_with('s') ? "" : "s", size_ >> 20U, gpu.properties().deviceName,
                               gpu.maxAllocation() >> 20U, kind == MemoryKind::Device ? "--size or model" : "--size"));
  }
  auto info = vkStruct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
  info.allocationSize = size_;
  info.memoryTypeIndex = memoryType(gpu, requirements.memoryTypeBits, kind, name);
  auto flags = vkStruct<VkMemoryAllocateFlagsInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO);
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  if (addressed) info.pNext = &flags;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  check(vkAllocateMemory(gpu.device(), &info, nullptr, &memory),
        fmt::format("allocating {} MiB for the {}", size_ >> 20U, name));
  memory_ = {gpu.device(), memory, vkFreeMemory};
  setDebugName(gpu.device(), VK_OBJECT_TYPE_DEVICE_MEMORY, memory, name);
  gpu.memoryAllocated(size_);
  gpu_ = &gpu;
}

Allocation::Allocation(Allocation&& other) noexcept
    : gpu_(std::exchange(other.gpu_, nullptr)), size_(other.size_), memory_(std::move(other.memory_)) {}

Allocation& Allocation::operator=(Allocation&& other) noexcept {
  Allocation moved(std::move(other));
  std::swap(gpu_, moved.gpu_);
  std::swap(size_, moved.size_);
  std::swap(memory_, moved.memory_);
  return *this;
}

Allocation::~Allocation() {
  if (gpu_ != nullptr) gpu_->memoryFreed(size_);
}

GpuBuffer::GpuBuffer(Gpu& gpu, std::uint64_t size, VkBufferUsageFlags usage, MemoryKind kind, const std::string& name)
    : size_(std::max<std::uint64_t>(size, 16)) {
  auto info = vkStruct<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.size = size_;
  info.usage = usage;
  info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  VkBuffer buffer = VK_NULL_HANDLE;
  check(vkCreateBuffer(gpu.device(), &info, nullptr, &buffer), fmt::format("vkCreateBuffer ({})", name));
  buffer_ = {gpu.device(), buffer, vkDestroyBuffer};
  setDebugName(gpu.device(), VK_OBJECT_TYPE_BUFFER, buffer, name);

  VkMemoryRequirements requirements{};
  vkGetBufferMemoryRequirements(gpu.device(), buffer, &requirements);
  allocation_ = Allocation(gpu, requirements, kind, name, (usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0);
  check(vkBindBufferMemory(gpu.device(), buffer, allocation_.get(), 0), "vkBindBufferMemory");
  if (kind != MemoryKind::Device) {
    check(vkMapMemory(gpu.device(), allocation_.get(), 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory");
  }
}

GpuImage::GpuImage(Gpu& gpu, const GpuImageInfo& info, const std::string& name) : info_(info) {
  const std::uint32_t largest = gpu.properties().limits.maxImageDimension2D;
  if (std::max(info.extent.width, info.extent.height) > largest) {
    throw GpuError(fmt::format("the {} would be {}x{} pixels; a side can be at most {} on {}", name, info.extent.width,
                               info.extent.height, largest, gpu.properties().deviceName));
  }
  auto create = vkStruct<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
  create.imageType = VK_IMAGE_TYPE_2D;
  create.format = info.format;
  create.extent = {info.extent.width, info.extent.height, 1};
  create.mipLevels = info.mipLevels;
  create.flags = info.flags;
  create.arrayLayers = info.arrayLayers;
  create.samples = info.samples;
  create.tiling = VK_IMAGE_TILING_OPTIMAL;
  create.usage = info.usage;
  create.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  create.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  VkImage image = VK_NULL_HANDLE;
  check(vkCreateImage(gpu.device(), &create, nullptr, &image), fmt::format("vkCreateImage ({})", name));
  image_ = {gpu.device(), image, vkDestroyImage};
  setDebugName(gpu.device(), VK_OBJECT_TYPE_IMAGE, image, name);

  VkMemoryRequirements requirements{};
  vkGetImageMemoryRequirements(gpu.device(), image, &requirements);
  allocation_ = Allocation(gpu, requirements, MemoryKind::Device, name);
  check(vkBindImageMemory(gpu.device(), image, allocation_.get(), 0), "vkBindImageMemory");

  auto viewInfo = vkStruct<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
  viewInfo.image = image;
  viewInfo.viewType = info.arrayLayers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  viewInfo.format = info.format;
  viewInfo.subresourceRange = range();
  VkImageView view = VK_NULL_HANDLE;
  check(vkCreateImageView(gpu.device(), &viewInfo, nullptr, &view), fmt::format("vkCreateImageView ({})", name));
  view_ = {gpu.device(), view, vkDestroyImageView};
  setDebugName(gpu.device(), VK_OBJECT_TYPE_IMAGE_VIEW, view, name);
}

VkImageSubresourceRange GpuImage::range() const { return {info_.aspect, 0, info_.mipLevels, 0, info_.arrayLayers}; }

} // namespace vitrail::tool
