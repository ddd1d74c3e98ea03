// The images that a picture is drawn into, and the rendering scopes and barriers of a frame's passes over them.
#pragma once

#include "resources.h"

namespace vitrail::tool {

class PictureImages {
 public:
  PictureImages() = default;
  // Throws GpuError where the device cannot render a picture of that size.
  PictureImages(Gpu& gpu, VkExtent2D extent);

  static constexpr VkFormat kColorFormat = VK_FORMAT_R16G16B16A16_SFLOAT; // linear, premultiplied alpha

  const GpuImage& color() const { return color_; }
  VkExtent2D extent() const { return color_.info().extent; }

  // Begins a rendering scope over the whole picture that clears colour to `background` and depth to 0, the far plane.
  // What the images held is lost.
  void cmdBeginOpaque(VkCommandBuffer commands, const VkClearColorValue& background) const;

  // After the opaque scope: begins one that tests against its depth and has no attachment to write.
  void cmdBeginCollect(VkCommandBuffer commands) const;

  // After the opaque scope: hands the colour image to compute shaders, in VK_IMAGE_LAYOUT_GENERAL.
  void cmdToCompute(VkCommandBuffer commands) const;

 private:
  void cmdBeginScope(VkCommandBuffer commands, const VkRenderingAttachmentInfo* color,
                     const VkRenderingAttachmentInfo& depth) const;

  GpuImage color_;
  GpuImage depth_;
};

} // namespace vitrail::tool
