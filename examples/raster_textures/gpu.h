// Vulkan for raster_textures.cpp, as little as it takes. Nothing in here concerns Vitrail.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <png.h>
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <vulkan/vulkan.hpp>

#include "scene.h"

constexpr vk::Extent2D kExtent{.width = 1600, .height = 1200}; // four pixels make one of the file
constexpr vk::Format kColorFormat = vk::Format::eR32G32B32A32Sfloat;
constexpr vk::Format kDepthFormat = vk::Format::eD32Sfloat;
// The first device, with Vulkan 1.3 for dynamic rendering.
struct Gpu {
  vk::UniqueInstance instance;
  vk::PhysicalDevice physicalDevice;
  uint32_t family = 0; // for graphics and compute
  vk::UniqueDevice device;

  Gpu() {
    const vk::ApplicationInfo application{.apiVersion = VK_API_VERSION_1_3};
    instance = vk::createInstanceUnique({.pApplicationInfo = &application});
    const std::vector<vk::PhysicalDevice> devices = instance->enumeratePhysicalDevices();
    if (devices.empty()) throw std::runtime_error("there is no Vulkan device");
    physicalDevice = devices[0];
    constexpr vk::QueueFlags kBoth = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
    const std::vector<vk::QueueFamilyProperties> families = physicalDevice.getQueueFamilyProperties();
    while (family + 1 < families.size() && (families[family].queueFlags & kBoth) != kBoth) ++family;
    const float priority = 1.0F;
    const vk::DeviceQueueCreateInfo queue{.queueFamilyIndex = family, .queueCount = 1, .pQueuePriorities = &priority};
    const vk::PhysicalDeviceVulkan13Features rendering{.synchronization2 = true, .dynamicRendering = true};
    const vk::PhysicalDeviceFeatures features{.fragmentStoresAndAtomics = true}; // what a context asks for
    device = physicalDevice.createDeviceUnique(
        {.pNext = &rendering, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue, .pEnabledFeatures = &features});
  }

  vk::UniqueDeviceMemory allocate(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) const {
    const vk::PhysicalDeviceMemoryProperties memory = physicalDevice.getMemoryProperties();
    for (uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
      const bool allowed = (needs.memoryTypeBits >> type & 1) != 0;
      if (!allowed || (memory.memoryTypes[type].propertyFlags & wanted) != wanted) continue;
      return device->allocateMemoryUnique({.allocationSize = needs.size, .memoryTypeIndex = type});
    }
    throw std::runtime_error("the device lacks a kind of memory");
  }
};

struct Image {
  vk::UniqueDeviceMemory memory;
  vk::UniqueImage image;
  vk::UniqueImageView view;
  vk::ImageSubresourceRange all;
};

inline Image createImage(const Gpu& gpu, vk::Format format, vk::ImageUsageFlags usage, vk::Extent2D extent = kExtent,
                         uint32_t levels = 1, uint32_t layers = 1) {
  Image result;
  vk::ImageCreateInfo info{.imageType = vk::ImageType::e2D, .format = format, .usage = usage};
  info.setExtent({extent.width, extent.height, 1}).setMipLevels(levels).setArrayLayers(layers);
  result.image = gpu.device->createImageUnique(info);
  const vk::MemoryRequirements needs = gpu.device->getImageMemoryRequirements(*result.image);
  result.memory = gpu.allocate(needs, vk::MemoryPropertyFlagBits::eDeviceLocal);
  gpu.device->bindImageMemory(*result.image, *result.memory, 0);
  const auto aspect = format == kDepthFormat ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor;
  result.all = vk::ImageSubresourceRange{aspect, 0, levels, 0, layers};
  vk::ImageViewCreateInfo view{.image = *result.image, .format = format, .subresourceRange = result.all};
  view.viewType = layers > 1 ? vk::ImageViewType::e2DArray : vk::ImageViewType::e2D;
  result.view = gpu.device->createImageViewUnique(view);
  return result;
}

// A buffer that the host writes or reads.
struct Buffer {
  vk::UniqueDeviceMemory memory;
  vk::UniqueBuffer buffer;
  void* data = nullptr;

  Buffer(const Gpu& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage) {
    using Memory = vk::MemoryPropertyFlagBits;
    buffer = gpu.device->createBufferUnique({.size = size, .usage = usage});
    memory =
        gpu.allocate(gpu.device->getBufferMemoryRequirements(*buffer), Memory::eHostVisible | Memory::eHostCoherent);
    gpu.device->bindBufferMemory(*buffer, *memory, 0);
    data = gpu.device->mapMemory(*memory, 0, VK_WHOLE_SIZE);
  }
  template <typename Value>
  Buffer(const Gpu& gpu, std::span<const Value> values, vk::BufferUsageFlags usage)
      : Buffer(gpu, (values.size_bytes() + 3) / 4 * 4, usage) { // shaders read whole words
    std::memcpy(data, values.data(), values.size_bytes());
  }
};

// What an image is used for: how it lies, by whom, and how.
struct Use {
  vk::ImageLayout layout;
  vk::PipelineStageFlags2 stages;
  vk::AccessFlags2 access;
};
using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
constexpr Use kDrawnColor{vk::ImageLayout::eColorAttachmentOptimal, Stage::eColorAttachmentOutput,
                          Access::eColorAttachmentWrite};
constexpr Use kDrawnDepth{vk::ImageLayout::eDepthStencilAttachmentOptimal,
                          Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
                          Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite};
// What the raster wants: it draws over the colour, and reads the depth.
constexpr Use kRasterColor{vk::ImageLayout::eGeneral, Stage::eComputeShader,
                           Access::eShaderRead | Access::eShaderWrite};
constexpr Use kRasterDepth{vk::ImageLayout::eDepthStencilReadOnlyOptimal, Stage::eComputeShader, Access::eShaderRead};
constexpr Use kWritten{vk::ImageLayout::eTransferDstOptimal, Stage::eAllTransfer, Access::eTransferWrite};
constexpr Use kSampled{vk::ImageLayout::eShaderReadOnlyOptimal, Stage::eFragmentShader | Stage::eComputeShader,
                       Access::eShaderRead};
constexpr Use kCopiedColor{vk::ImageLayout::eGeneral, Stage::eAllTransfer, Access::eTransferRead};

inline void recordBarrier(vk::CommandBuffer commands, const Image& image, const Use& before, const Use& after) {
  vk::ImageMemoryBarrier2 barrier{.oldLayout = before.layout, .newLayout = after.layout, .image = *image.image};
  barrier.setSrcStageMask(before.stages).setSrcAccessMask(before.access);
  barrier.setDstStageMask(after.stages).setDstAccessMask(after.access);
  barrier.setSubresourceRange(image.all);
  commands.pipelineBarrier2(vk::DependencyInfo{}.setImageMemoryBarriers(barrier));
}

// Writer: the raster, or the resolve of lists. Reader: the copy, whose reader is the host.
inline void recordCopy(vk::CommandBuffer commands, const Image& color, vk::Buffer copy) {
  recordBarrier(commands, color, kRasterColor, kCopiedColor);
  vk::BufferImageCopy region{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1}};
  commands.copyImageToBuffer(*color.image, vk::ImageLayout::eGeneral, copy,
                             region.setImageExtent({kExtent.width, kExtent.height, 1}));
  vk::MemoryBarrier2 toHost{.srcStageMask = Stage::eAllTransfer, .srcAccessMask = Access::eTransferWrite};
  toHost.setDstStageMask(Stage::eHost).setDstAccessMask(Access::eHostRead);
  commands.pipelineBarrier2(vk::DependencyInfo{}.setMemoryBarriers(toHost));
}

inline void savePng(const float* pixels, const char* path) {
  constexpr uint32_t kWidth = kExtent.width / 2, kHeight = kExtent.height / 2, kRow = 4 * kExtent.width;
  std::vector<png_byte> bytes;
  for (uint32_t i = 0; i < kWidth * kHeight * 3; ++i) {
    const float* p = pixels + size_t{2} * kRow * (i / 3 / kWidth) + 8 * (i / 3 % kWidth) + i % 3;
    bytes.push_back(png_byte(std::lround(255 * toSrgb((p[0] + p[4] + p[kRow] + p[kRow + 4]) / 4))));
  }
  png_image image{nullptr, PNG_IMAGE_VERSION, kWidth, kHeight, PNG_FORMAT_RGB, 0, 0, 0, {}};
  if (png_image_write_to_file(&image, path, 0, bytes.data(), 0, nullptr) == 0) {
    throw std::runtime_error(std::string("cannot write ") + path + ": " + image.message);
  }
}
