// Vulkan objects that tests own: buffers, images that know what they were used for last, and one command buffer.
#pragma once

#include <functional>
#include <memory>
#include <type_traits>

#include "device.h"

namespace vitrail::tests::vulkan {

template <typename Handle>
struct Destroy {
  VkDevice device = VK_NULL_HANDLE;
  void(VKAPI_PTR* function)(VkDevice, Handle, const VkAllocationCallbacks*) = nullptr;

  void operator()(Handle handle) const { function(device, handle, nullptr); }
};

// A handle that is destroyed with it: handles are pointers on the machines that the tests run on.
template <typename Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Destroy<Handle>>;

// make(device, vkCreateFence, vkDestroyFence, info)
template <typename Handle, typename Info>
Owned<Handle> make(const Device& device,
                   VkResult(VKAPI_PTR* create)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*),
                   void(VKAPI_PTR* destroy)(VkDevice, Handle, const VkAllocationCallbacks*), const Info& info) {
  Handle handle = VK_NULL_HANDLE;
  check(create(device.get(), &info, nullptr, &handle), "creating an object");
  return Owned<Handle>(handle, {device.get(), destroy});
}

// Where memory is: the device's own, or mapped by the host, which writes and reads it.
enum class Memory { Device, Host };

class Buffer {
 public:
  Buffer() = default;
  // Of at least one word.
  Buffer(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage, Memory memory);

  [[nodiscard]] VkBuffer get() const { return buffer_.get(); }
  [[nodiscard]] VkDeviceSize size() const { return size_; }
  [[nodiscard]] void* mapped() const { return mapped_; } // null for Memory::Device

 private:
  VkDeviceSize size_ = 0;
  void* mapped_ = nullptr;
  Owned<VkDeviceMemory> memory_; // before the buffer: it goes after it
  Owned<VkBuffer> buffer_;
};

// One side of a barrier.
struct Access {
  VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
  VkAccessFlags2 accesses = VK_ACCESS_2_NONE;

  bool operator==(const Access&) const = default;
};

// What the host's passes do.
inline constexpr Access kColorBlend{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
inline constexpr Access kDepthTest{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT};
inline constexpr Access kDepthWrite{kDepthTest.stages,
                                    kDepthTest.accesses | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
inline constexpr Access kCopyRead{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
inline constexpr Access kCopyWrite{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr Access kTransferWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr Access kHostAccess{VK_PIPELINE_STAGE_2_HOST_BIT,
                                    VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT};

void cmdBarrier(VkCommandBuffer commands, const Access& before, const Access& after);

class Image {
 public:
  Image() = default;
  Image(const Device& device, VkExtent2D extent, VkFormat format, VkSampleCountFlagBits samples,
        VkImageUsageFlags usage);

  [[nodiscard]] explicit operator bool() const { return image_ != nullptr; }
  [[nodiscard]] VkImage get() const { return image_.get(); }
  [[nodiscard]] VkImageView view() const { return view_.get(); }
  // For shaders, which see one aspect only: depth where there is depth.
  [[nodiscard]] VkImageView sampledView() const { return sampled_.get(); }

  // The image is used so from here on, in that layout: after what it was used for before.
  void cmdUse(VkCommandBuffer commands, VkImageLayout layout, const Access& access);
  // What it holds is not needed any more, and nobody uses it.
  void forget();

 private:
  VkImageAspectFlags aspects_ = 0;
  VkImageLayout layout_ = VK_IMAGE_LAYOUT_UNDEFINED;
  Access access_;
  Owned<VkDeviceMemory> memory_; // before the image: it goes after it
  Owned<VkImage> image_;
  Owned<VkImageView> view_;
  Owned<VkImageView> sampled_;
};

// Records one command buffer, submits it, and waits for it.
class Commands {
 public:
  explicit Commands(const Device& device);

  // What was begun before and not executed is dropped.
  VkCommandBuffer begin();
  void execute();
  void run(const std::function<void(VkCommandBuffer)>& record);

 private:
  const Device& device_;
  Owned<VkCommandPool> pool_;
  Owned<VkFence> fence_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

} // namespace vitrail::tests::vulkan
