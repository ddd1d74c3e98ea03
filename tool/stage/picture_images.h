// The images that a picture is drawn into, and the rendering scopes and barriers of a frame's passes over them.
#pragma once

#include "../gpu/resources.h"
#include "../gpu/scope.h"
#include "../gpu/used_image.h"

namespace vitrail::tool {

// What who draws transparent surfaces asks of the images.
struct ImageNeeds {
  // Several samples: surfaces are blended into the multisampled image, which is box-filtered; else the multisampled
  // colour is sampled, and the picture of one sample written.
  bool perSample = false;
  bool stencil = false;             // depth has a stencil beside it
  VkImageUsageFlags depthUsage = 0; // of depth beside being tested and written: sampled, copied
};

struct PictureImagesInfo : ImageNeeds {
  VkExtent2D extent{};
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
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

  VkExtent2D size() const { return info_.extent; }
  // What of it frames draw, from the top left corner: all, until a part is chosen.
  VkExtent2D extent() const { return part_; }
  void setPart(VkExtent2D part) { part_ = part; }
  VkSampleCountFlagBits samples() const { return info_.samples; }
  VkFormat depthFormat() const { return depthFormat(info_.stencil); }
  const GpuImage& multisampled() const { return multisampled_.get(); } // none at one sample
  VkImageView sampledDepth() const { return sampledDepth_.get(); }     // of the depth aspect; null unless sampled
  VkImageView sampledStencil() const { return sampledStencil_.get(); } // of the stencil; null unless that is sampled

  // The picture: one sample, with storage usage.
  UsedImage& color() { return color_; }
  // What the opaque scope drew into, and its depth: with several samples the multisampled image, else the picture.
  UsedImage& drawn() { return info_.samples > VK_SAMPLE_COUNT_1_BIT ? multisampled_ : color_; }
  UsedImage& depth() { return depth_; }

  // Begins a rendering scope over the whole picture that clears colour to `background`, depth to 0, the far plane, and
  // stencil to 0. What the images held is lost, once those who use them are done.
  void cmdBeginOpaque(VkCommandBuffer commands, const VkClearColorValue& background);

  // A scope over the whole picture without attachments.
  Scope wholeScope() const;

  // A scope over `area` that tests against the opaque scene's depth, writes none, and writes the stencil where there is
  // one. It has no colour yet: that is drawn(), or images of a method's own.
  Scope transparentScope(const VkRect2D& area);

  // Hands the images to a resolve by compute: the picture, and the multisampled colour and the depth where they are
  // sampled, which reads and writes the first in VK_IMAGE_LAYOUT_GENERAL and samples the others in
  // VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL (colour) and VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL (depth).
  void cmdToComputeResolve(VkCommandBuffer commands);

  // The scope of a resolve that is drawn over `area`: into drawn(), with the stencil where there is one; where the
  // resolve takes several samples to one, into the picture, and the others are handed over as above.
  Scope resolveScope(VkCommandBuffer commands, const VkRect2D& area);

  // Takes the multisampled image to the picture, the mean of each pixel's samples.
  void cmdBoxFilter(VkCommandBuffer commands);

  // Hands the picture to compute shaders that read it, in VK_IMAGE_LAYOUT_GENERAL.
  void cmdToEncode(VkCommandBuffer commands);

 private:
  PictureImagesInfo info_;
  VkExtent2D part_{};
  UsedImage color_;
  UsedImage multisampled_;
  UsedImage depth_;
  Unique<VkImageView> sampledDepth_;
  Unique<VkImageView> sampledStencil_;
};

} // namespace vitrail::tool
