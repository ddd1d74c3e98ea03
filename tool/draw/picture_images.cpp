#include "picture_images.h"

#include <algorithm>

#include <fmt/format.h>

#include "barrier.h"
#include "vk.h"

namespace vitrail::tool {

namespace {

constexpr Access kNothing{};
constexpr Access kColorWrite{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
constexpr Access kDepthTest{VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                            VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT};
constexpr Access kDepthWrite{kDepthTest.stages, kDepthTest.accesses | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
constexpr Access kComputeReadWrite{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                   VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};

VkRenderingAttachmentInfo attachment(const GpuImage& image, VkImageLayout layout, VkAttachmentLoadOp load,
                                     VkAttachmentStoreOp store) {
  auto info = vkStruct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
  info.imageView = image.view();
  info.imageLayout = layout;
  info.loadOp = load;
  info.storeOp = store;
  return info;
}

void checkExtent(const Gpu& gpu, VkExtent2D extent) {
  const VkPhysicalDeviceLimits& limits = gpu.properties().limits;
  const std::uint32_t width =
      std::min({limits.maxImageDimension2D, limits.maxFramebufferWidth, limits.maxViewportDimensions[0]});
  const std::uint32_t height =
      std::min({limits.maxImageDimension2D, limits.maxFramebufferHeight, limits.maxViewportDimensions[1]});
  if (extent.width < 1 || extent.height < 1) throw GpuError("a picture has at least 1x1 pixels");
  if (extent.width > width || extent.height > height) {
    throw GpuError(fmt::format("a picture of {}x{} pixels is too large: {} renders at most {}x{}", extent.width,
                               extent.height, gpu.properties().deviceName, width, height));
  }
}

} // namespace

PictureImages::PictureImages(Gpu& gpu, VkExtent2D extent) {
  checkExtent(gpu, extent);
  GpuImageInfo color;
  color.extent = extent;
  color.format = kColorFormat;
  color.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
  color_ = GpuImage(gpu, color, "colour image");
  GpuImageInfo depth;
  depth.extent = extent;
  depth.format = VK_FORMAT_D32_SFLOAT;
  depth.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  depth.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  depth_ = GpuImage(gpu, depth, "depth image");
}

void PictureImages::cmdBeginScope(VkCommandBuffer commands, const VkRenderingAttachmentInfo* color,
                                  const VkRenderingAttachmentInfo& depth) const {
  const VkRect2D area{{0, 0}, extent()};
  auto info = vkStruct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
  info.renderArea = area;
  info.layerCount = 1;
  info.colorAttachmentCount = color != nullptr ? 1 : 0;
  info.pColorAttachments = color;
  info.pDepthAttachment = &depth;
  vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{0.0F, 0.0F, static_cast<float>(area.extent.width), static_cast<float>(area.extent.height),
                            0.0F, 1.0F};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &area);
}

void PictureImages::cmdBeginOpaque(VkCommandBuffer commands, const VkClearColorValue& background) const {
  // Nobody (the frame before was waited for) -> the clear and the opaque draws write colour.
  cmdImageBarrier(commands, color_.get(), color_.range(), VK_IMAGE_LAYOUT_UNDEFINED, kNothing,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorWrite);
  // Nobody -> the clear and the opaque draws write and test depth.
  cmdImageBarrier(commands, depth_.get(), depth_.range(), VK_IMAGE_LAYOUT_UNDEFINED, kNothing,
                  VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, kDepthWrite);
  auto color = attachment(color_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR,
                          VK_ATTACHMENT_STORE_OP_STORE);
  color.clearValue.color = background;
  auto depth = attachment(depth_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR,
                          VK_ATTACHMENT_STORE_OP_STORE);
  depth.clearValue.depthStencil = {0.0F, 0};
  cmdBeginScope(commands, &color, depth);
}

void PictureImages::cmdBeginCollect(VkCommandBuffer commands) const {
  // The opaque draws wrote depth -> the transparent draws test against it.
  cmdImageBarrier(commands, depth_.get(), depth_.range(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, kDepthWrite,
                  VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, kDepthTest);
  cmdBeginScope(commands, nullptr,
                attachment(depth_, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD,
                           VK_ATTACHMENT_STORE_OP_NONE));
}

void PictureImages::cmdToCompute(VkCommandBuffer commands) const {
  // The opaque draws wrote colour -> the resolve reads and writes it, and the encoding reads it.
  cmdImageBarrier(commands, color_.get(), color_.range(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorWrite,
                  VK_IMAGE_LAYOUT_GENERAL, kComputeReadWrite);
}

} // namespace vitrail::tool
