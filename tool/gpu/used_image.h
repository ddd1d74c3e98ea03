// An image that knows what it was used for last, so that each use states its own side of a barrier only.
#pragma once

#include <string>

#include "barrier.h"
#include "resources.h"

namespace vitrail::tool {

class UsedImage {
 public:
  UsedImage() = default;
  explicit UsedImage(GpuImage image) : image_(std::move(image)) {}

  const GpuImage& get() const { return image_; }

  // Makes the image what `info` says, unless it is that: for images that are kept from picture to picture. True where
  // it was made, so that descriptors of it are written again. No command buffer that uses it may be pending.
  bool ensure(Gpu& gpu, const GpuImageInfo& info, const std::string& name);

  // The image is used so from here on, in that layout: after what it was used for before.
  void cmdUse(VkCommandBuffer commands, VkImageLayout layout, const Access& access);
  // All of it is `value`, whatever it held and whoever used it; its layout is VK_IMAGE_LAYOUT_GENERAL. For images with
  // transfer destination usage. Outside a rendering scope.
  void cmdClear(VkCommandBuffer commands, const VkClearColorValue& value);
  // What it holds is not needed any more; the next use waits for the last one.
  void discard() { layout_ = VK_IMAGE_LAYOUT_UNDEFINED; }

 private:
  // What it holds is not needed any more, and nobody uses it.
  void forget();

  GpuImage image_;
  VkImageLayout layout_ = VK_IMAGE_LAYOUT_UNDEFINED;
  Access access_;
};

} // namespace vitrail::tool
