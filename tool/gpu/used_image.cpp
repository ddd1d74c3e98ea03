#include "used_image.h"

#include "accesses.h"

namespace vitrail::tool {

namespace {

constexpr VkAccessFlags2 kReads = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT |
                                  VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                                  VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT;

bool same(const GpuImageInfo& a, const GpuImageInfo& b) {
  return a.extent.width == b.extent.width && a.extent.height == b.extent.height && a.format == b.format &&
         a.usage == b.usage && a.mipLevels == b.mipLevels && a.arrayLayers == b.arrayLayers && a.flags == b.flags &&
         a.samples == b.samples && a.aspect == b.aspect;
}

} // namespace

bool UsedImage::ensure(Gpu& gpu, const GpuImageInfo& info, const std::string& name) {
  if (image_.get() != VK_NULL_HANDLE && same(image_.info(), info)) return false;
  image_ = GpuImage(); // first: the old image and the new one need not fit together
  image_ = GpuImage(gpu, info, name);
  forget();
  return true;
}

void UsedImage::cmdUse(VkCommandBuffer commands, VkImageLayout layout, const Access& access) {
  const bool same = layout == layout_ && access.stages == access_.stages && access.accesses == access_.accesses;
  if (same && (access.accesses & ~kReads) == 0) return; // reading goes on
  cmdImageBarrier(commands, image_.get(), image_.range(), layout_, access_, layout, access);
  layout_ = layout;
  access_ = access;
}

void UsedImage::cmdClear(VkCommandBuffer commands, const VkClearColorValue& value) {
  discard();
  // Who used it last -> it is cleared.
  cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kClear);
  const VkImageSubresourceRange all = image_.range();
  vkCmdClearColorImage(commands, image_.get(), VK_IMAGE_LAYOUT_GENERAL, &value, 1, &all);
}

void UsedImage::forget() {
  layout_ = VK_IMAGE_LAYOUT_UNDEFINED;
  access_ = {};
}

} // namespace vitrail::tool
