// The images that a picture is drawn into, and the rendering scopes and barriers of a frame's passes over them.
#pragma once

#include "barrier.h"
#include "resources.h"

namespace vitrail::tool {

struct PictureImagesInfo {
  VkExtent2D extent{};
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  bool perSample = false;    // several samples: surfaces are blended into the multisampled image, which is box-filtered
  bool stencil = false;      // depth has a stencil beside it
  bool sampledDepth = false; // shaders read the depth
};

// An image that knows what it was used for last, so that each use states its own side of a barrier only.
class UsedImage {
 public:
  UsedImage() = default;
  explicit UsedImage(GpuImage image) : image_(std::move(image)) {}

  const GpuImage& get() const { return image_; }

  // The image is used so from here on, in that layout: after what it was used for before.
  void cmdUse(VkCommandBuffer commands, VkImageLayout layout, const Access& access);
  // What it holds is not needed any more, and nobody uses it.
  void forget();

 private:
  GpuImage image_;
  VkImageLayout layout_ = VK_IMAGE_LAYOUT_UNDEFINED;
  Access access_;
};

class PictureImages {
 public:
  PictureImages() = default;
  // Throws GpuError where the device cannot render a picture of that size.
  PictureImages(Gpu& gpu, const PictureImagesInfo& info);

  static constexpr VkFormat kColorFormat = VK_FORMAT_R16G16B16A16_SFLOAT; // linear, premultiplied alpha
  static constexpr VkFormat depthFormat(bool stencil) {
    return stencil ? VK_FORMAT_D32_SFLOAT_S8_UINT : VK_FORMAT_D32_SFLOAT;
  }

  VkExtent2D extent() const { return info_.extent; }
  const GpuImage& color() const { return color_.get(); }               // the picture: single-sample
  const GpuImage& multisampled() const { return multisampled_.get(); } // none at one sample
  VkImageView sampledDepth() const { return sampledDepth_.get(); }     // of the depth aspect; null unless asked for

  // Begins a rendering scope over the whole picture that clears colour to `background`, depth to 0, the far plane, and
  // stencil to 0. What the images held is lost; nobody uses them any more.
  void cmdBeginOpaque(VkCommandBuffer commands, const VkClearColorValue& background);

  // After the opaque scope: begins one over `area` that tests against its depth, writes none, and has the stencil where
  // there is one. With `color` it draws into the image that the opaque scope drew into.
  void cmdBeginTransparent(VkCommandBuffer commands, const VkRect2D& area, bool color);

  // Hands the images to a resolve by compute, as Method::cmdResolve() takes them.
  void cmdToComputeResolve(VkCommandBuffer commands);

  // Begins the scope of a resolve that is drawn over `area`: into the image that the opaque scope drew into, with the
  // stencil where there is one; where the resolve takes several samples to one, into the picture.
  void cmdBeginResolve(VkCommandBuffer commands, const VkRect2D& area);

  // Takes the multisampled image to the picture, the mean of each pixel's samples.
  void cmdBoxFilter(VkCommandBuffer commands);

  // Hands the picture to compute shaders that read it, in VK_IMAGE_LAYOUT_GENERAL.
  void cmdToEncode(VkCommandBuffer commands);

 private:
  UsedImage& drawn() { return info_.samples > VK_SAMPLE_COUNT_1_BIT ? multisampled_ : color_; }
  void cmdToSampled(VkCommandBuffer commands, VkPipelineStageFlags2 stage);

  PictureImagesInfo info_;
  UsedImage color_;
  UsedImage multisampled_;
  UsedImage depth_;
  Unique<VkImageView> sampledDepth_;
};

} // namespace vitrail::tool
