// Buffers and images with memory of their own.
#pragma once

#include <cstdint>
#include <string>

#include "device.h"
#include "unique.h"

namespace vitrail::tool {

enum class MemoryKind {
  Device,  // the GPU's own
  Upload,  // written by the host: mapped, coherent
  Readback // read by the host: mapped, coherent, cached where the device has it
};

// One allocation of device memory, counted by the Gpu.
class Allocation {
 public:
  Allocation() = default;
  // Throws GpuError, also where the device cannot allocate so much at once. `name` says what it is for. `addressed`:
  // for a buffer that shaders reach by its address.
  Allocation(Gpu& gpu, const VkMemoryRequirements& requirements, MemoryKind kind, const std::string& name,
             bool addressed = false);
  Allocation(Allocation&& other) noexcept;
  Allocation& operator=(Allocation&& other) noexcept;
  ~Allocation();

  VkDeviceMemory get() const { return memory_.get(); }

 private:
  Gpu* gpu_ = nullptr;
  std::uint64_t size_ = 0;
  Unique<VkDeviceMemory> memory_;
};

class GpuBuffer {
 public:
  GpuBuffer() = default;
  // `size` in bytes; 0 makes the smallest buffer there is.
  GpuBuffer(Gpu& gpu, std::uint64_t size, VkBufferUsageFlags usage, MemoryKind kind, const std::string& name);

  VkBuffer get() const { return buffer_.get(); }
  std::uint64_t size() const { return size_; }
  void* mapped() const { return mapped_; } // null for MemoryKind::Device

 private:
  std::uint64_t size_ = 0;
  void* mapped_ = nullptr;
  Allocation allocation_;
  Unique<VkBuffer> buffer_;
};

struct GpuImageInfo {
  VkExtent2D extent{};
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkImageUsageFlags usage = 0;
  std::uint32_t mipLevels = 1;
  std::uint32_t arrayLayers = 1; // several: the view is that of an array
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  VkImageCreateFlags flags = 0;
};

// A 2D image, or an array of them, in the GPU's memory and the view of all of it.
class GpuImage {
 public:
  GpuImage() = default;
  // Throws GpuError where a side is larger than the device's largest image.
  GpuImage(Gpu& gpu, const GpuImageInfo& info, const std::string& name);

  VkImage get() const { return image_.get(); }
  VkImageView view() const { return view_.get(); }
  const GpuImageInfo& info() const { return info_; }
  // All of it, for barriers.
  VkImageSubresourceRange range() const;

 private:
  GpuImageInfo info_;
  Allocation allocation_;
  Unique<VkImage> image_;
  Unique<VkImageView> view_;
};

} // namespace vitrail::tool
