// The last pass of a picture that stays on the GPU: the linear picture to an image of the 8-bit codes that EncodePass
// gives, which windows sample.
#pragma once

#include <memory>

#include "../gpu/descriptors.h"
#include "../gpu/resources.h"

namespace vitrail::tool {

class EncodeImagePass {
 public:
  explicit EncodeImagePass(Gpu& gpu);

  // What a picture is encoded to. The source outlives its frames.
  struct Output {
    GpuImage image; // R8G8B8A8_UNORM, as large as the source; also to be copied from
    SingleSet set;
  };
  // `color` is R16G16B16A16_SFLOAT with storage usage.
  std::shared_ptr<Output> makeOutput(const GpuImage& color) const;

  // Encodes the part of that size, from the top left corner of the source, which is read by compute in
  // VK_IMAGE_LAYOUT_GENERAL. Nobody uses the output any more. Afterwards fragment shaders of all that is submitted
  // behind it may sample the output in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL. `pixels`: the host gets it, too, rows
  // of the part without padding, in a buffer with transfer destination usage, once the GPU is done; null: it does not.
  // Outside a rendering scope.
  void cmdEncode(VkCommandBuffer commands, const Output& output, VkExtent2D part, VkBuffer pixels) const;

 private:
  Gpu& gpu_;
  SingleSet anySet_; // for its layout: those of outputs are like it
  Unique<VkPipelineLayout> layout_;
  Unique<VkPipeline> pipeline_;
};

} // namespace vitrail::tool
