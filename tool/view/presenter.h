// Shows pictures and Dear ImGui's widgets in a window, through Vulkan.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../gpu/device.h"
#include "../gpu/resources.h"
#include "../gpu/unique.h"
#include "../image/picture.h"
#include "swapchain.h"
#include "window.h"

struct ImDrawData;

namespace vitrail::tool {

class Presenter {
 public:
  // Shows pictures with `gpu`, which outlives it, where that does (Gpu::presents), else with a device of its own: a
  // GPU, else a CPU driver. The window outlives it. `validate`: as GpuOptions has it. Throws WindowError and GpuError.
  Presenter(Window& window, Gpu* gpu, bool validate);
  ~Presenter();
  Presenter(const Presenter&) = delete;
  Presenter& operator=(const Presenter&) = delete;

  // The two pictures of a window.
  enum class Side { Picture, Beside };
  // What ImGui::Image() and ImDrawList::AddImage() take for a picture of setPicture(): as it is, pixel by pixel, or
  // smoothed.
  [[nodiscard]] static void* texture(Side side, bool smooth);
  // The picture of the frames to come.
  void setPicture(Side side, const Picture& picture);
  // The same of one that the GPU of the constructor has drawn, and has been waited for: R8G8B8A8_UNORM, in
  // VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL. It is held until nobody samples it.
  void setPicture(Side side, std::shared_ptr<const GpuImage> image);

  // Shows what ImGui has drawn. False: nothing was shown, as the window has no size, or the device is not ready for the
  // next frame within Swapchain::kPatience: who uses the window is heard meanwhile. Throws GpuError.
  bool show(ImDrawData& data, bool vsync);

  // The validation layer's errors of a device of its own; waits for the device, and shows nothing any more.
  std::vector<std::string> finish();

 private:
  static constexpr std::size_t kFont = 2; // behind those of Side
  static constexpr std::size_t kTextures = 3;

  // Whatever belongs to one of the frames in flight.
  struct Slot {
    Unique<VkCommandPool> pool;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    Unique<VkFence> done;
    Unique<VkSemaphore> acquired;
    GpuBuffer vertices;
    GpuBuffer indices;
    GpuBuffer pixels; // of a picture that this frame copies
    // The textures that it samples, and sets of them: as they are, smoothed.
    std::array<std::shared_ptr<const GpuImage>, kTextures> images;
    std::array<std::array<VkDescriptorSet, 2>, kTextures> sets{};
  };
  struct Texture {
    std::shared_ptr<const GpuImage> image;
    std::vector<std::uint8_t> pixels; // to be copied to it; empty: they are there
    bool isOwn = false;               // setPicture() was not given it
  };

  void makeSlot(Slot& slot);
  void makeFont();
  void setTexture(Texture& texture, PixelSize size, std::vector<std::uint8_t> pixels, const char* name);
  void fillTextures(Slot& slot);
  void holdTextures(Slot& slot) const;
  void reserve(GpuBuffer& buffer, std::uint64_t bytes, VkBufferUsageFlags usage, const char* name) const;
  void draw(Slot& slot, const Swapchain::Image& image, ImDrawData& data);
  void copyGeometry(Slot& slot, const ImDrawData& data) const;
  void submit(Slot& slot, const Swapchain::Image& image) const;

  Window& window_;
  std::unique_ptr<Gpu> own_; // null: it is somebody else's
  Gpu* gpu_;
  std::unique_ptr<Swapchain> swapchain_;
  Unique<VkDescriptorSetLayout> setLayout_;
  Unique<VkDescriptorPool> sets_;
  std::array<Unique<VkSampler>, 2> samplers_; // as it is, smoothed
  Unique<VkPipelineLayout> layout_;
  Unique<VkPipeline> pipeline_;
  static constexpr std::size_t kFrames = 2; // in flight
  std::array<Slot, kFrames> slots_;
  std::size_t next_ = 0;
  std::array<Texture, kTextures> textures_;
};

} // namespace vitrail::tool
