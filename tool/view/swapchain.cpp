#include "swapchain.h"

#include <algorithm>

#include "../gpu/vk.h"

namespace vitrail::tool {

namespace {

VkPresentModeKHR presentMode(VkPhysicalDevice device, VkSurfaceKHR surface, bool vsync) {
  if (vsync) return VK_PRESENT_MODE_FIFO_KHR; // every device has it
  std::uint32_t count = 0;
  check(vkGetPhysicalDeviceSurfacePresentModesKHR(device, surface, &count, nullptr), "the window's present modes");
  std::vector<VkPresentModeKHR> modes(count);
  check(vkGetPhysicalDeviceSurfacePresentModesKHR(device, surface, &count, modes.data()), "the window's present modes");
  for (const VkPresentModeKHR mode : {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR}) {
    if (std::ranges::find(modes, mode) != modes.end()) return mode;
  }
  return VK_PRESENT_MODE_FIFO_KHR;
}

Unique<VkSemaphore> makeSemaphore(Gpu& gpu) {
  const auto info = vkStruct<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
  VkSemaphore semaphore = VK_NULL_HANDLE;
  check(vkCreateSemaphore(gpu.device(), &info, nullptr, &semaphore), "vkCreateSemaphore");
  return {gpu.device(), semaphore, vkDestroySemaphore};
}

} // namespace

Swapchain::Swapchain(Gpu& gpu, VkSurfaceKHR surface) : gpu_(gpu), surface_(surface) { chooseFormat(); }

Swapchain::~Swapchain() {
  gpu_.waitIdle();
  slots_.clear();
  vkDestroySwapchainKHR(gpu_.device(), swapchain_, nullptr);
  vkDestroySurfaceKHR(gpu_.instance(), surface_, nullptr);
}

void Swapchain::chooseFormat() {
  std::uint32_t count = 0;
  check(vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_.physicalDevice(), surface_, &count, nullptr), "the window's formats");
  std::vector<VkSurfaceFormatKHR> formats(count);
  check(vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_.physicalDevice(), surface_, &count, formats.data()),
        "the window's formats");
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_A8B8G8R8_UNORM_PACK32}) {
    for (const VkSurfaceFormatKHR& format : formats) {
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
        format_ = format;
        return;
      }
    }
  }
  throw GpuError("the window has no format of 8-bit colours: vitrail render writes pictures without one");
}

void Swapchain::loseSurface(const Window& window) {
  gpu_.waitIdle();
  slots_.clear();
  vkDestroySwapchainKHR(gpu_.device(), std::exchange(swapchain_, VK_NULL_HANDLE), nullptr);
  vkDestroySurfaceKHR(gpu_.instance(), std::exchange(surface_, VK_NULL_HANDLE), nullptr);
  surface_ = window.makeSurface(gpu_.instance());
  lost_ = false;
  stale_ = true;
}

bool Swapchain::fit(const Window& window, bool vsync) {
  if (lost_) loseSurface(window);
  VkSurfaceCapabilitiesKHR capabilities{};
  const VkResult result = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu_.physicalDevice(), surface_, &capabilities);
  if (result == VK_ERROR_SURFACE_LOST_KHR) {
    lost_ = true;
    return false;
  }
  check(result, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
  VkExtent2D extent = capabilities.currentExtent;
  if (extent.width == UINT32_MAX) { // the images say how large the window is
    const PixelSize size = window.size();
    extent.width = std::clamp(size.width, capabilities.minImageExtent.width, capabilities.maxImageExtent.width);
    extent.height = std::clamp(size.height, capabilities.minImageExtent.height, capabilities.maxImageExtent.height);
    if (size.width == 0 || size.height == 0) return false;
  }
  if (extent.width == 0 || extent.height == 0) return false;
  const bool same = extent.width == extent_.width && extent.height == extent_.height;
  if (stale_ || !same || vsync != vsync_) make(capabilities, extent, vsync);
  return true;
}

void Swapchain::make(const VkSurfaceCapabilitiesKHR& capabilities, VkExtent2D extent, bool vsync) {
  check(gpu_.waitIdle(), "vkDeviceWaitIdle");
  auto info = vkStruct<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
  info.surface = surface_;
  info.minImageCount = capabilities.minImageCount + 1;
  if (capabilities.maxImageCount != 0) info.minImageCount = std::min(info.minImageCount, capabilities.maxImageCount);
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  info.preTransform = capabilities.currentTransform;
  for (const VkCompositeAlphaFlagBitsKHR alpha :
       {VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR, VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR}) {
    if ((capabilities.supportedCompositeAlpha & alpha) != 0) {
      info.compositeAlpha = alpha;
      break;
    }
  }
  info.presentMode = presentMode(gpu_.physicalDevice(), surface_, vsync);
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain_;
  VkSwapchainKHR made = VK_NULL_HANDLE;
  check(vkCreateSwapchainKHR(gpu_.device(), &info, nullptr, &made), "vkCreateSwapchainKHR");
  slots_.clear();
  vkDestroySwapchainKHR(gpu_.device(), swapchain_, nullptr);
  swapchain_ = made;
  std::uint32_t count = 0;
  check(vkGetSwapchainImagesKHR(gpu_.device(), swapchain_, &count, nullptr), "vkGetSwapchainImagesKHR");
  std::vector<VkImage> images(count);
  check(vkGetSwapchainImagesKHR(gpu_.device(), swapchain_, &count, images.data()), "vkGetSwapchainImagesKHR");
  for (VkImage image : images) {
    auto view = vkStruct<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkImageView handle = VK_NULL_HANDLE;
    check(vkCreateImageView(gpu_.device(), &view, nullptr, &handle), "vkCreateImageView (window)");
    slots_.push_back({image, {gpu_.device(), handle, vkDestroyImageView}, makeSemaphore(gpu_)});
  }
  extent_ = extent;
  vsync_ = vsync;
  stale_ = false;
}

std::optional<Swapchain::Image> Swapchain::acquire(VkSemaphore acquired) {
  std::uint32_t index = 0;
  const VkResult result = vkAcquireNextImageKHR(gpu_.device(), swapchain_, kPatience, acquired, VK_NULL_HANDLE, &index);
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_ERROR_SURFACE_LOST_KHR) {
    stale_ = true;
    lost_ = result == VK_ERROR_SURFACE_LOST_KHR;
    return std::nullopt;
  }
  if (result == VK_TIMEOUT || result == VK_NOT_READY) return std::nullopt;
  if (result != VK_SUBOPTIMAL_KHR) check(result, "vkAcquireNextImageKHR");
  const Slot& slot = slots_[index];
  return Image{index, slot.image, slot.view.get(), extent_, slot.rendered.get()};
}

void Swapchain::present(const Image& image) {
  auto info = vkStruct<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &image.rendered;
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain_;
  info.pImageIndices = &image.index;
  const VkResult result = gpu_.present(info);
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_SURFACE_LOST_KHR) {
    stale_ = true;
    lost_ = result == VK_ERROR_SURFACE_LOST_KHR;
    return;
  }
  check(result, "vkQueuePresentKHR");
}

} // namespace vitrail::tool
