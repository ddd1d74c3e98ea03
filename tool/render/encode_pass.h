// The last pass: the linear picture to 8-bit sRGB pixels that the host reads.
#pragma once

#include <cstdint>
#include <vector>

#include "../gpu/descriptors.h"
#include "../gpu/resources.h"

namespace vitrail::tool {

class EncodePass {
 public:
  explicit EncodePass(Gpu& gpu);

  // Makes the output of a picture. `color` is R16G16B16A16_SFLOAT with storage usage and outlives its frames.
  void setSource(const GpuImage& color);

  // Reads the source by compute in VK_IMAGE_LAYOUT_GENERAL and makes the pixels visible to the host. Outside a
  // rendering scope.
  void cmdEncode(VkCommandBuffer commands) const;

  // The pixels of the last finished frame, 4 bytes each, rows top to bottom without padding.
  std::vector<std::uint8_t> pixels() const;

 private:
  Gpu& gpu_;
  SingleSet set_;
  Unique<VkPipelineLayout> layout_;
  Unique<VkPipeline> pipeline_;
  VkExtent2D extent_{};
  std::uint32_t bandRows_ = 0; // a shader reaches a limited part of a buffer: large pictures are encoded in bands
  GpuBuffer output_;
};

} // namespace vitrail::tool
