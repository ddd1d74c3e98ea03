// The images of a window.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "../gpu/device.h"
#include "../gpu/unique.h"
#include "window.h"

namespace vitrail::tool {

class Swapchain {
 public:
  // Takes the surface. The window and the Gpu outlive it.
  Swapchain(Gpu& gpu, VkSurfaceKHR surface);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  // Codes are shown as they are written: no sRGB conversion.
  [[nodiscard]] VkFormat format() const { return format_.format; }

  // Makes the images for a window of that size, neither side 0; nothing where they fit. `vsync` false: pictures are
  // shown as soon as the system can. Waits for the device where something is made. False: the window has no size now.
  // Throws GpuError, also where the surface is lost and cannot be made again.
  bool fit(const Window& window, bool vsync);

  struct Image {
    std::uint32_t index = 0;
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkExtent2D extent{};
    VkSemaphore rendered = VK_NULL_HANDLE; // the drawing signals it
  };
  static constexpr std::uint64_t kPatience = 4'000'000; // nanoseconds, of whoever waits for the device

  // The next image to draw on, once `acquired` is signalled. Nothing: the images fit no more: fit() again; or there is
  // none within kPatience.
  std::optional<Image> acquire(VkSemaphore acquired);
  // Shows it.
  void present(const Image& image);

 private:
  struct Slot {
    VkImage image = VK_NULL_HANDLE;
    Unique<VkImageView> view;
    Unique<VkSemaphore> rendered;
  };

  void chooseFormat();
  void make(const VkSurfaceCapabilitiesKHR& capabilities, VkExtent2D extent, bool vsync);
  void loseSurface(const Window& window);

  Gpu& gpu_;
  VkSurfaceKHR surface_;
  VkSurfaceFormatKHR format_{};
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_{};
  std::vector<Slot> slots_;
  bool vsync_ = true;
  bool stale_ = true; // to be made again
  bool lost_ = false; // the surface
};

} // namespace vitrail::tool
