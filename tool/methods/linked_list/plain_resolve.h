// Pictures without the nearest surfaces of each pixel, and pictures whose surfaces are blended in the order in which
// they arrived: a resolve of the tool's own over the library's lists (plain_resolve.comp).
#pragma once

#include <array>
#include <cstdint>

#include "../../gpu/descriptors.h"
#include "../../gpu/pipeline.h"
#include "../method.h"

namespace vitrail::tool {

class PlainResolve {
 public:
  // `lists` is the layout of the library's set. Of several samples the opaque colour is sampled, and so is the depth
  // where the device's coverage has not passed the test of it. Throws GpuError.
  PlainResolve(Gpu& gpu, VkDescriptorSetLayout lists, std::uint32_t samples, bool sorted);

  // Writes the picture of `target`.
  void setTarget(const MethodTarget& target);

  // Blends the lists of an area over the opaque picture, without the `peeled` nearest surfaces. Where lists lack
  // fragments: what there is of them, or nothing. Images and lists are there for compute shaders. Outside a rendering
  // scope.
  void cmdResolve(VkCommandBuffer commands, VkDescriptorSet lists, VkExtent2D area, std::uint32_t peeled,
                  bool showsLess) const;

 private:
  std::uint32_t samples_;
  bool testsDepth_;
  SingleSet set_;
  Unique<VkPipelineLayout> layout_;
  Unique<VkPipeline> pipeline_;
};

} // namespace vitrail::tool
