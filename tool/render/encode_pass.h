// The last pass: the linear picture to pixels that the host reads.
#pragma once

#include <cstdint>
#include <vector>

#include "../gpu/descriptors.h"
#include "../gpu/resources.h"
#include "../image/picture.h"

namespace vitrail::tool {

class EncodePass {
 public:
  explicit EncodePass(Gpu& gpu);

  // Makes the output of a picture. `color` is R16G16B16A16_SFLOAT with storage usage and outlives its frames.
  void setSource(const GpuImage& color);

  // How the next frames are encoded; Encoding::Srgb8 without it. No frame is pending.
  void setEncoding(Encoding encoding);

  // Reads the source by compute in VK_IMAGE_LAYOUT_GENERAL and makes the pixels visible to the host. Outside a
  // rendering scope.
  void cmdEncode(VkCommandBuffer commands) const;

  // The pixels of the last finished frame, rows top to bottom without padding: of Encoding::Srgb8, or of the others.
  std::vector<std::uint8_t> pixels() const;
  std::vector<std::uint16_t> deepPixels() const;

 private:
  void makeOutput();
  std::uint64_t rowBytes() const;

  Gpu& gpu_;
  SingleSet set_;
  Unique<VkPipelineLayout> layout_;
  Unique<VkPipeline> pipeline_;
  Encoding encoding_ = Encoding::Srgb8;
  VkExtent2D extent_{};
  std::uint32_t bandRows_ = 0; // a shader reaches a limited part of a buffer: large pictures are encoded in bands
  GpuBuffer output_;
};

} // namespace vitrail::tool
