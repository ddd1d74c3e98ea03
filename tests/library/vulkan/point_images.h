// The images of one frame of the Vulkan point host: the opaque scene, the depth that points are tested against, the
// picture; with the rendering scopes and barriers around the library's calls.
#pragma once

#include <vector>

#include "../host.h"
#include "objects.h"
#include "point_pipelines.h"

namespace vitrail::tests::vulkan {

class PointImages {
 public:
  PointImages() = default;
  PointImages(const Device& device, const HostDesc& desc);

  static VkFormat colorFormat(const HostDesc& desc);
  static VkFormat depthFormat(const HostDesc& desc); // VK_FORMAT_UNDEFINED: there is no depth

  // What the library reads and writes.
  [[nodiscard]] VkImageView color() const { return color_.view(); }
  [[nodiscard]] VkImageView multisampled() const { return multisampled_.view(); }
  [[nodiscard]] VkImageView depth() const { return depth_.sampledView(); }

  // Draws the opaque scene: one colour and one depth a sample. What the images held is lost.
  void cmdOpaque(VkCommandBuffer commands, PointPipelines& pipelines);
  // Begins the scope that points are drawn in: no colour, depth is tested.
  void cmdBeginPoints(VkCommandBuffer commands);
  // Hands the images to the library's resolve, for VITRAIL_RESOLVE_FRAGMENT in a scope that it begins.
  void cmdToResolve(VkCommandBuffer commands);
  // Copies the picture to the host; with a multisampled one, the mean of its samples.
  void cmdPicture(VkCommandBuffer commands);

  // The picture, after that has been executed. Nothing for formats that are not read back.
  [[nodiscard]] std::vector<FloatColor> pixels() const;

 private:
  [[nodiscard]] bool severalSamples() const { return desc_.samples > 1; }
  [[nodiscard]] bool perSample() const {
    return severalSamples() && desc_.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  }
  void cmdClear(VkCommandBuffer commands);
  void cmdBeginResolve(VkCommandBuffer commands);
  void cmdBeginScope(VkCommandBuffer commands, const VkRenderingAttachmentInfo* color,
                     const VkRenderingAttachmentInfo* depth, const VkRenderingAttachmentInfo* stencil) const;

  HostDesc desc_;
  Image color_;        // single-sample
  Image multisampled_; // where there are several
  Image depth_;        // with a stencil where points mark it
  Buffer readback_;
};

} // namespace vitrail::tests::vulkan
